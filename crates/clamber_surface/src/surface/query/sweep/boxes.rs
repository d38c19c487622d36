//! Triangles near a box, over the tick.

use glam::Vec3;

use super::super::broad::{Lanes, SLACK, each_lane, lanes};
use super::super::stack::Stack;
use super::super::{check_point, root};
use super::cluster::MovingCluster;
use crate::mesh::TriangleId;
use crate::mesh::hierarchy::Child;
use crate::surface::bounds::Spheres;
use crate::surface::{SkinnedSurface, SurfaceError};

/// A triangle on its way from the previous pose to the current one, in the current model frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingTriangle {
    /// Which one.
    pub triangle: TriangleId,
    /// Its corners a tick ago.
    pub previous: [Vec3; 3],
    /// Its corners now.
    pub current: [Vec3; 3],
}

impl MovingTriangle {
    /// Whether its own box, that around its corners a tick ago and now, meets the box from `low` to
    /// `high`, touching included.
    pub fn meets_box(&self, low: Vec3, high: Vec3) -> bool {
        let corners = self.previous.iter().chain(&self.current);
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for corner in corners {
            min = min.min(*corner);
            max = max.max(*corner);
        }
        low.cmple(max).all() && min.cmple(high).all()
    }
}

impl SkinnedSurface {
    /// Every triangle that moves within the box from `low` to `high` between the previous pose and the
    /// current one, both ends included: by [its own box](MovingTriangle::meets_box), so that none is
    /// missed that enters the box, and some come along that pass it by a corner. In no promised order.
    ///
    /// A box whose `low` is above its `high` meets nothing.
    ///
    /// # Errors
    /// [`SurfaceError::Point`] if `low` or `high` is not finite; nothing is visited then.
    pub fn visit_box(
        &self,
        low: Vec3,
        high: Vec3,
        mut visit: impl FnMut(&MovingTriangle),
    ) -> Result<(), SurfaceError> {
        check_point(low)?;
        check_point(high)?;
        let poses = [&self.previous, &self.current];
        let bounds = poses[0].root().union(poses[1].root());
        let sides = [low.to_array(), high.to_array()];
        if !low.cmple(high).all() || !root::overlaps(&bounds, sides[0], sides[1]) {
            return Ok(());
        }
        let hierarchy = self.mesh.hierarchy();
        let mut cluster = MovingCluster::new(self, poses);
        let mut stack = Stack::new(0, hierarchy.further_roots());
        while let Some(index) = stack.pop() {
            let node = &hierarchy.nodes[index as usize];
            let near = near_box(&self.moving_spheres(poses, index), sides);
            for lane in each_lane(near & node.lane_mask()) {
                match node.child(lane) {
                    Child::Node(child) => stack.push(child),
                    Child::Cluster(index) => {
                        if cluster.visit(index) {
                            let found = cluster.in_box(sides);
                            for triangle in cluster.view.enabled(found) {
                                visit(&cluster.moving(triangle));
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Lanes of which anything may meet the box on its way between two poses: all of it lies in the box
/// around the spheres at both.
fn near_box([start, end]: &[Spheres; 2], [low, high]: [[f32; 3]; 2]) -> Lanes {
    let axes = |spheres: &Spheres, lane: usize| {
        [spheres.x[lane], spheres.y[lane], spheres.z[lane]].map(|x| (x, spheres.radius[lane]))
    };
    lanes(|lane| {
        let (first, last) = (axes(start, lane), axes(end, lane));
        // Negated, so that NaN touches.
        !(0..3).any(|axis| {
            let beyond = |(x, radius): (f32, f32)| {
                let reach = radius + SLACK * (x.abs() + radius);
                (x + reach < low[axis], x - reach > high[axis])
            };
            let (first, last) = (beyond(first[axis]), beyond(last[axis]));
            first.0 && last.0 || first.1 && last.1
        })
    })
}
