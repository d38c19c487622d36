use glam::{DQuat, Quat};

use super::deformation::material_frame;
use super::{SkinnedSurface, SurfaceError};
use crate::mesh::{ColliderMesh, MeshId, TriangleId};
use crate::query::{CapsuleHit, SurfaceHit, SweepHit};
use crate::rig::rotation_f32;

/// How far barycentric coordinates may be from a sum of 1: some rounding of three f32.
const BARYCENTRIC_TOLERANCE: f32 = 1e-5;

/// A point of a mesh's material, wherever that is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfacePoint {
    /// The mesh that has the triangle.
    pub mesh: MeshId,
    /// The triangle that the point lies on.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1.
    pub barycentric: [f32; 3],
}

macro_rules! point_of {
    ($($hit:ident),*) => {$(
        impl From<&$hit> for SurfacePoint {
            fn from(hit: &$hit) -> Self {
                Self {
                    mesh: hit.mesh,
                    triangle: hit.triangle,
                    barycentric: hit.barycentric,
                }
            }
        }
    )*};
}
point_of!(SurfaceHit, SweepHit, Anchor);

impl From<&CapsuleHit> for SurfacePoint {
    fn from(hit: &CapsuleHit) -> Self {
        (&hit.surface).into()
    }
}

/// A material point: it stays where it is on the skin, whatever the skin does.
///
/// A small plain value. It is tied to a triangle, so it holds for every surface whose mesh has that: see
/// [`MeshId`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor {
    /// The mesh that has the triangle.
    pub mesh: MeshId,
    /// The triangle that the point lies on.
    pub triangle: TriangleId,
    /// Weights of its corners: not negative, sum 1.
    pub barycentric: [f32; 3],
    /// The rotation of the material around the point from rest to now, in model space, as it was
    /// last known. It stands in where the triangle collapses, and matters nowhere else: whose skin may collapse stores
    /// [`Motion::frame`](crate::surface::Motion::frame), which
    /// [`ModelSpace::motion`](crate::surface::ModelSpace::motion) gives, here in each tick.
    pub frame: Quat,
}

impl SkinnedSurface {
    /// Creates an anchor at a hit or any other point of the surface, as it is posed now.
    ///
    /// # Errors
    /// [`SurfaceError::ForeignMesh`] for a point of another mesh, [`SurfaceError::Triangle`] for one whose triangle was
    /// removed since, [`SurfaceError::Barycentric`] for weights that are not finite, negative, or do not add up to 1.
    pub fn anchor_at(&self, point: impl Into<SurfacePoint>) -> Result<Anchor, SurfaceError> {
        let point = point.into();
        check_mesh(self.mesh(), point.mesh)?;
        self.anchor(point.triangle, point.barycentric)
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
        let mesh = self.mesh();
        let joint = mesh.joint_of(triangle);
        let joint = joint.ok_or(SurfaceError::Triangle(triangle))?;
        check_barycentric(barycentric)?;
        let instance = &self.instance;
        let matrix = &instance.current.palette()[joint.index()];
        let rest = mesh.rest_corners(triangle);
        let frame = material_frame(rest, instance.corners(triangle), matrix);
        Ok(Anchor {
            mesh: mesh.id_of(triangle),
            triangle,
            barycentric,
            frame: rotation_f32(frame.unwrap_or(DQuat::IDENTITY)),
        })
    }
}

/// Refuses what belongs to another mesh.
pub(super) fn check_mesh(mesh: &ColliderMesh, found: MeshId) -> Result<(), SurfaceError> {
    if mesh.continues(found) {
        Ok(())
    } else {
        let expected = mesh.id();
        Err(SurfaceError::ForeignMesh { expected, found })
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
