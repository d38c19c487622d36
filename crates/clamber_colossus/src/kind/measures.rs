use clamber_animation::rig::Skeleton;
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::skin::skin;
use clamber_surface::surface::SurfaceError;
use glam::{DVec3, Vec3};

use crate::error::ColossusError;

/// The skin of a kind of creature, posed at rest, in model space. All sizes come from it: positions of a mesh in its
/// file may have another scale, and lie elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct RestSkin {
    pub(crate) positions: Vec<Vec3>,
    /// Least and largest coordinates of all triangles.
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Half the width, on the ground, of what is under it: the largest `min(|x|, |z|)`, so that arms that are held
    /// aside do not count.
    pub(crate) girth: f64,
}

impl RestSkin {
    pub(crate) fn new(skeleton: &Skeleton, mesh: &ColliderMesh) -> Result<Self, ColossusError> {
        let palette = skeleton.palette(&skeleton.rest_pose())?;
        let positions = skin(mesh, palette.matrices()).map_err(SurfaceError::from)?;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut girth = 0f64;
        for corner in mesh.triangles().iter().flatten() {
            let p = positions[corner.index()].as_dvec3();
            (low, high) = (low.min(p), high.max(p));
            girth = girth.max(p.x.abs().min(p.z.abs()));
        }
        Ok(Self {
            positions,
            low,
            high,
            girth,
        })
    }

    /// Height along Y.
    pub(crate) fn height(&self) -> f64 {
        self.high.y - self.low.y
    }
}
