//! Triangles that enter a box over the tick.

use fearless_simd::{Simd, dispatch};
use glam::Vec3;

use super::cluster::PosedCluster;
use super::instance::Instance;
use super::traverse::traverse;
use super::{ModelSpace, broad, root};
use crate::mesh::TriangleId;
use crate::mesh::hierarchy::LANES;
use crate::pose::PosedMesh;

/// A triangle that moves from the previous pose to the current one, in the current model frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingTriangle {
    /// The triangle's id.
    pub triangle: TriangleId,
    /// The corners a tick ago.
    pub previous: [Vec3; 3],
    /// The corners now.
    pub current: [Vec3; 3],
}

impl MovingTriangle {
    /// True if the triangle's bounding box, around its corners a tick ago and now, overlaps or touches the box from
    /// `low` to `high`.
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

impl ModelSpace<'_> {
    /// Calls `visit` with every enabled triangle that enters the box from `low` to `high`, in model space, at any time
    /// from the previous pose to the current one.
    ///
    /// Also visits some triangles that stay outside although their [bounding box](MovingTriangle::meets_box) enters.
    /// The order is unspecified.
    ///
    /// Visits no triangle if `low` is above `high` on any axis, or if a coordinate is not finite.
    pub fn visit_box(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(&MovingTriangle)) {
        let instance = self.instance;
        let poses = [&instance.previous, &instance.current];
        let bounds = poses[0].root().union(poses[1].root());
        let sides = [low.to_array(), high.to_array()];
        let is_box = low.is_finite() && high.is_finite() && low.cmple(high).all();
        if !is_box || !root::overlaps(&bounds, sides[0], sides[1]) {
            return;
        }
        dispatch!(instance.simd_level.level(), simd => {
            instance.descend_box(simd, poses, sides, &mut visit);
        });
    }
}

impl Instance {
    #[cfg_attr(not(unoptimized), inline(always))]
    fn descend_box<S: Simd>(
        &self,
        simd: S,
        poses: [&PosedMesh; 2],
        sides: [[f32; 3]; 2],
        visit: &mut impl FnMut(&MovingTriangle),
    ) {
        traverse::<false>(
            self.mesh.hierarchy(),
            0.0,
            #[cfg_attr(not(unoptimized), inline(always))]
            |node, _| {
                let bounds = poses.map(|pose| pose.bounds(&self.mesh, node));
                (broad::near_box(simd, bounds, sides), [0.0; LANES])
            },
            #[cfg_attr(not(unoptimized), inline(always))]
            |cluster, limit| {
                if let Some(posed) = PosedCluster::visit(self, poses, cluster)
                    && posed.enters(sides)
                {
                    for triangle in posed.in_box(simd, sides).iter() {
                        let [previous, current] = posed.corners(triangle);
                        visit(&MovingTriangle {
                            triangle: posed.id(triangle),
                            previous,
                            current,
                        });
                    }
                }
                Some(limit)
            },
        );
    }
}
