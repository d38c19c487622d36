//! Queries on the posed surface. All are in model space and see triangles from both sides.

mod closest;
mod hit;
mod overlap;
mod ray;

pub use hit::SurfaceHit;

use super::{SkinnedSurface, SurfaceError};
use crate::geometry::Sphere;
use crate::mesh::TriangleId;

/// How far the f32 arithmetic of a query may reach beyond the exact one, as a share of the
/// coordinates involved: 16 units of 2^-23. Bounds are widened by it, so that no bound hides what
/// the triangle test behind it would report. Smaller risks a missed triangle; larger tests more.
const SLACK: f64 = 16.0 * f32::EPSILON as f64;

impl SkinnedSurface {
    /// Ids of the enabled triangles in parts whose sphere passes `meets`.
    fn triangles_near<'a>(
        &'a self,
        meets: impl Fn(&Sphere) -> bool + 'a,
    ) -> impl Iterator<Item = TriangleId> + 'a {
        let parts = self.mesh.parts().iter().enumerate();
        parts
            .filter(move |(part, _)| {
                self.part_enabled[*part] && self.spheres[*part].as_ref().is_some_and(&meets)
            })
            .flat_map(|(_, part)| part.triangles.iter().copied())
            .filter(|triangle| self.triangle_enabled[triangle.index()])
    }

    /// Ids of all enabled triangles, for the brute-force references.
    fn all_triangles(&self) -> impl Iterator<Item = TriangleId> {
        let count = self.mesh.triangles().len() as u32;
        (0..count)
            .map(TriangleId)
            .filter(|triangle| self.is_enabled(*triangle))
    }
}

/// Refuses lengths that are NaN or negative; infinity is a length.
fn check_length(what: &'static str, length: f32) -> Result<f64, SurfaceError> {
    if length >= 0.0 {
        Ok(f64::from(length))
    } else {
        Err(SurfaceError::Query {
            what,
            found: f64::from(length),
        })
    }
}
