//! Triangles near a box, over the tick.

use glam::Vec3;

use super::super::broad::{Lanes, SLACK, each_lane, lanes};
use super::super::stack::Stack;
use super::super::{check_point, root};
use super::cluster::MovingCluster;
use crate::mesh::TriangleId;
use crate::mesh::hierarchy::{Child, LANES};
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
    let mut beyond = [false; LANES];
    for (axis, (first, last)) in axes(start).into_iter().zip(axes(end)).enumerate() {
        for lane in 0..LANES {
            let reach = |spheres: &Spheres, x: f32| {
                spheres.radius[lane] + SLACK * (x.abs() + spheres.radius[lane])
            };
            let (x, y) = (first[lane], last[lane]);
            let (at_x, at_y) = (reach(start, x), reach(end, y));
            // NaN is beyond nothing, so it touches.
            beyond[lane] |= (x + at_x < low[axis]) & (y + at_y < low[axis]);
            beyond[lane] |= (x - at_x > high[axis]) & (y - at_y > high[axis]);
        }
    }
    lanes(|lane| !beyond[lane])
}

fn axes(spheres: &Spheres) -> [&[f32; LANES]; 3] {
    [&spheres.x, &spheres.y, &spheres.z]
}
