//! Queries of a posed surface, in its own model space. All see triangles from both sides.
//!
//! A query descends the hierarchy by spheres that come from the palette alone, has the clusters
//! skinned that it reaches, rules out most of their triangles by planes, and tests the others
//! exactly, in f64 on the f32 corners. Bounds only ever rule out what the exact test would refuse, so
//! the answer is that of testing every triangle, bit for bit.

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
mod traverse;

pub use boxes::MovingTriangle;
pub use cast::{CastOptions, TargetMotion};
pub use hit::{CapsuleHit, SurfaceHit, SweepHit};
pub(crate) use instance::Instance;

use glam::Vec3;

use crate::geometry::Sphere;
use crate::mesh::{PartId, VertexId};

/// A surface in its own model space, in f32: queries, and where vertices and parts are. Got from
/// [`SkinnedSurface::in_model`](crate::surface::SkinnedSurface::in_model).
///
/// Ray lengths and the distances of closest-point queries may be infinite. A length that is NaN or negative finds
/// nothing.
#[derive(Clone, Copy, Debug)]
pub struct ModelSpace<'a> {
    pub(crate) instance: &'a Instance,
}

impl ModelSpace<'_> {
    /// Where a vertex stands now; `None` if it does not exist or was removed.
    pub fn position(&self, vertex: VertexId) -> Option<Vec3> {
        self.instance.position_in(&self.instance.current, vertex)
    }

    /// Where a vertex stood a tick ago, in the current model frame; `None` if it does not exist or was
    /// removed. One that was added since stood where the palette of a tick ago would have had it.
    pub fn previous_position(&self, vertex: VertexId) -> Option<Vec3> {
        self.instance.position_in(&self.instance.previous, vertex)
    }

    /// For every part that has triangles a sphere that holds it as it is posed now, from the palette alone. O(joints of
    /// the part) each. The first call on a mesh reads all its rest data.
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
