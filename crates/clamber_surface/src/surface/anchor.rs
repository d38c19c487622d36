use glam::{DQuat, Quat};

use super::deformation::{Flattened, Rest};
use super::{SkinnedSurface, SurfaceError};
use crate::mesh::{ColliderMesh, MeshId, TriangleId};
use crate::query::{SurfaceHit, SweepHit};
use crate::rig::rotation_f32;

/// Largest deviation of the sum of barycentric coordinates from 1, and of one coordinate below 0: covers the rounding
/// of three f32.
const BARYCENTRIC_TOLERANCE: f32 = 1e-5;

/// A material point of a mesh: a triangle and the weights of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfacePoint {
    /// The mesh that the triangle belongs to.
    pub mesh: MeshId,
    /// The triangle that the point lies on.
    pub triangle: TriangleId,
    /// Weights of the triangle's corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
}

impl<V> From<&SurfaceHit<V>> for SurfacePoint {
    fn from(hit: &SurfaceHit<V>) -> Self {
        Self {
            mesh: hit.mesh,
            triangle: hit.triangle,
            barycentric: hit.barycentric,
        }
    }
}

impl<V> From<&SweepHit<V>> for SurfacePoint {
    fn from(sweep: &SweepHit<V>) -> Self {
        (&sweep.hit).into()
    }
}

impl From<&Anchor> for SurfacePoint {
    fn from(anchor: &Anchor) -> Self {
        Self {
            mesh: anchor.mesh,
            triangle: anchor.triangle,
            barycentric: anchor.barycentric,
        }
    }
}

/// A material point with the orientation of the skin around it. It keeps its place on the skin under any deformation.
///
/// A small plain value. It refers to a triangle, so it is valid on every surface whose mesh has that triangle: see
/// [`MeshId`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor {
    /// The mesh that the triangle belongs to.
    pub mesh: MeshId,
    /// The triangle that the point lies on.
    pub triangle: TriangleId,
    /// Weights of the triangle's corners: not negative, sum 1 up to rounding.
    pub barycentric: [f32; 3],
    /// The last known rotation of the material around the point from rest, in model space. It is used only if the
    /// triangle is collapsed both now and a tick ago. If the skin may collapse, store
    /// [`Motion::frame`](crate::surface::Motion::frame) here in each tick;
    /// [`ModelSpace::motion`](crate::surface::ModelSpace::motion) returns it.
    pub frame: Quat,
}

impl SkinnedSurface {
    /// Creates an anchor at a hit or any other point of the surface, in the current pose.
    ///
    /// # Errors
    /// [`SurfaceError::ForeignMesh`] if the point belongs to another mesh, [`SurfaceError::Triangle`] if its triangle
    /// was removed since or does not exist, [`SurfaceError::Barycentric`] if its weights are not finite, are negative,
    /// or do not add up to 1.
    pub fn anchor_at(&self, point: impl Into<SurfacePoint>) -> Result<Anchor, SurfaceError> {
        let point = point.into();
        check_mesh(self.mesh(), point.mesh)?;
        self.anchor(point.triangle, point.barycentric)
    }

    /// Creates an anchor from a triangle and the weights of its corners, in the current pose.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if the triangle does not exist or was removed, [`SurfaceError::Barycentric`] if the
    /// weights are not finite, are negative, or do not add up to 1.
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
        let now = Flattened::new(instance.corners(triangle));
        let frame = Rest::new(mesh.rest_corners(triangle)).frame(now.as_ref(), matrix);
        Ok(Anchor {
            mesh: mesh.id_of(triangle),
            triangle,
            barycentric,
            frame: rotation_f32(frame.unwrap_or(DQuat::IDENTITY)),
        })
    }
}

/// Refuses a point of another mesh.
pub(super) fn check_mesh(mesh: &ColliderMesh, found: MeshId) -> Result<(), SurfaceError> {
    if mesh.continues(found) {
        Ok(())
    } else {
        let expected = mesh.id();
        Err(SurfaceError::ForeignMesh { expected, found })
    }
}

/// Refuses weights that are not finite, are negative, or do not add up to 1.
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
