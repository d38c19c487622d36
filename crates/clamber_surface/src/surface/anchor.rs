use glam::{DQuat, Quat};

use super::deformation::material_frame;
use super::{SkinnedSurface, SurfaceError, SurfaceHit};
use crate::mesh::TriangleId;
use crate::rig::rotation_f32;

/// How far barycentric coordinates may be from a sum of 1: some rounding of three f32.
const BARYCENTRIC_TOLERANCE: f32 = 1e-5;

/// A material point: it stays where it is on the skin, whatever the skin does.
///
/// A small plain value. It is tied to a triangle id, so it holds for every surface that shares the
/// mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The triangle that the point lies on.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1.
    pub barycentric: [f32; 3],
    /// The rotation of the material around the point from rest to now, in model space, as it was
    /// last known. Stands in where the triangle has collapsed; store
    /// [`crate::surface::Motion::frame`] here each tick to keep it fresh.
    pub frame: Quat,
}

impl SkinnedSurface {
    /// The material point of a hit on this surface, as posed now.
    pub fn anchor_at(&self, hit: &SurfaceHit) -> Anchor {
        self.anchor_unchecked(hit.triangle, hit.barycentric)
    }

    /// A material point by triangle and corner weights.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`], [`SurfaceError::Barycentric`].
    pub fn anchor(
        &self,
        triangle: TriangleId,
        barycentric: [f32; 3],
    ) -> Result<Anchor, SurfaceError> {
        if self.mesh.part_of(triangle).is_none() {
            return Err(SurfaceError::Triangle(triangle));
        }
        check_barycentric(barycentric)?;
        Ok(self.anchor_unchecked(triangle, barycentric))
    }

    fn anchor_unchecked(&self, triangle: TriangleId, barycentric: [f32; 3]) -> Anchor {
        let frame = self.mesh.part_of(triangle).and_then(|part| {
            let joint = self.mesh.parts()[part.index()].joint.0 as usize;
            let rest = self.mesh.rest_corners(triangle);
            material_frame(rest, self.corners(triangle), &self.current.palette()[joint])
        });
        Anchor {
            triangle,
            barycentric,
            frame: rotation_f32(frame.unwrap_or(DQuat::IDENTITY)),
        }
    }
}

/// Refuses weights that are not finite, negative, or do not add up to 1.
pub(super) fn check_barycentric(weights: [f32; 3]) -> Result<(), SurfaceError> {
    let sum = weights[0] + weights[1] + weights[2];
    // Written so that NaN is refused.
    let usable = weights.iter().all(|w| *w >= -BARYCENTRIC_TOLERANCE)
        && (sum - 1.0).abs() <= BARYCENTRIC_TOLERANCE;
    if usable {
        Ok(())
    } else {
        Err(SurfaceError::Barycentric(weights))
    }
}
