//! Queries of a posed surface, in its own model space. All queries meet triangles from both sides.
//!
//! A query descends the hierarchy by spheres that follow from the palette alone and skins the clusters that it reaches.
//! It rules out most of their triangles by planes, and tests the others exactly, in f64 on the f32 corners. Bounds rule
//! out only triangles that the exact test would reject, so the result has the bits of testing every triangle.

mod boxes;
mod broad;
pub(crate) mod brute_force;
mod cast;
mod closest;
mod cluster;
mod hit;
mod inside;
mod instance;
mod narrow;
mod overlap;
mod planes;
mod probe;
mod ray;
mod root;
mod span;
mod traverse;

pub use boxes::MovingTriangle;
pub use cast::{CastOptions, TargetMotion};
pub use hit::{SurfaceHit, SweepHit};
pub(crate) use instance::Instance;

use glam::Vec3;

use crate::geometry::Sphere;
use crate::mesh::{PartId, VertexId};

/// A view of a surface in its own model space, in f32: queries, and positions of vertices and parts.
/// [`SkinnedSurface::in_model`](crate::surface::SkinnedSurface::in_model) returns it.
///
/// Ray lengths and the distances of closest-point queries may be infinite. A length that is NaN or negative finds
/// nothing.
#[derive(Clone, Copy, Debug)]
pub struct ModelSpace<'a> {
    pub(crate) instance: &'a Instance,
}

impl ModelSpace<'_> {
    /// The current position of a vertex, in model space; `None` if the vertex does not exist or was removed.
    pub fn position(&self, vertex: VertexId) -> Option<Vec3> {
        self.instance.position_in(&self.instance.current, vertex)
    }

    /// The position of a vertex a tick ago, in the current model frame; `None` if the vertex does not exist or was
    /// removed. For a vertex that was added since, it is the position that the palette of a tick ago gives it.
    pub fn previous_position(&self, vertex: VertexId) -> Option<Vec3> {
        self.instance.position_in(&self.instance.previous, vertex)
    }

    /// A bounding sphere for each part that has triangles, in the current pose and in model space. Spheres follow from
    /// the palette alone and cost O(joints of the part) each. The first call on a mesh reads all its rest data.
    pub fn part_spheres(&self) -> impl Iterator<Item = (PartId, Sphere)> {
        self.instance.current.part_spheres(&self.instance.mesh)
    }
}

/// A length in f64; `None` if it is NaN or negative.
fn length(length: f32) -> Option<f64> {
    (length >= 0.0).then(|| f64::from(length))
}

#[cfg(test)]
mod tests;
