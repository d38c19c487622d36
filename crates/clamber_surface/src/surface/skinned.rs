use std::sync::Arc;

use glam::Vec3;

use super::refit::part_sphere;
use super::{SurfaceError, refit_part_spheres};
use crate::geometry::{Affine, MAX_COORDINATE, Similarity, Sphere};
use crate::mesh::{ColliderMesh, PartId, TriangleId, VertexId};
use crate::rig::{JointId, Palette};
use crate::skin::{skin_into, skin_vertex};

/// One posed instance of a [`ColliderMesh`], with a current and a previous pose.
///
/// All its geometry is in the creature's model space, in f32; [`SkinnedSurface::world_from_model`]
/// takes it to the world. Between two ticks every vertex moves on a straight line in the *current*
/// model frame: the previous palette is re-expressed in it, so that a moving root is part of every
/// vertex's motion.
///
/// ```
/// use std::sync::Arc;
/// use clamber_surface::geometry::{Affine, Ray, Similarity};
/// use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
/// use clamber_surface::rig::{JointId, Palette};
/// use clamber_surface::surface::SkinnedSurface;
/// use glam::Vec3;
///
/// let (mesh, _) = ColliderMesh::build(
///     &MeshSource {
///         positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
///         triangles: &[[0, 1, 2]],
///         influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
///         joint_count: 1,
///         ..MeshSource::default()
///     },
///     &BuildOptions::default(),
/// )?;
/// let mut surface = SkinnedSurface::new(Arc::new(mesh));
/// let mut lifted = Affine::IDENTITY;
/// lifted.rows[2][3] = 0.5;
/// surface.advance(&Palette::from_matrices([lifted]), Similarity::IDENTITY)?;
///
/// let ray = Ray::new(Vec3::new(0.2, 0.2, 2.0), -Vec3::Z).unwrap();
/// let hit = surface.cast_ray(&ray, 10.0)?.unwrap();
/// assert_eq!(hit.distance, 1.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SkinnedSurface {
    pub(super) mesh: Arc<ColliderMesh>,
    pub(super) palette: Vec<Affine>,
    /// Of the previous tick, expressed in the current model frame.
    pub(super) previous_palette: Vec<Affine>,
    world_from_model: Similarity,
    pub(super) positions: Vec<Vec3>,
    pub(super) spheres: Vec<Option<Sphere>>,
    /// Per part: its joint's matrix mirrors.
    pub(super) mirrored: Vec<bool>,
    pub(super) part_enabled: Vec<bool>,
    pub(super) triangle_enabled: Vec<bool>,
}

impl SkinnedSurface {
    /// A surface at rest at the world's origin: every matrix of its palette is the identity.
    pub fn new(mesh: Arc<ColliderMesh>) -> Self {
        let palette = vec![Affine::IDENTITY; mesh.joint_count()];
        let mut surface = Self {
            previous_palette: palette.clone(),
            palette,
            world_from_model: Similarity::IDENTITY,
            positions: mesh.positions().to_vec(),
            spheres: Vec::new(),
            mirrored: Vec::new(),
            part_enabled: vec![true; mesh.parts().len()],
            triangle_enabled: vec![true; mesh.triangles().len()],
            mesh,
        };
        surface.refit();
        surface
    }

    /// The next tick: what is current becomes previous, and the given pose becomes current.
    ///
    /// # Errors
    /// [`SurfaceError::JointCount`], [`SurfaceError::Palette`] or [`SurfaceError::WorldFromModel`];
    /// the surface is unchanged then.
    pub fn advance(
        &mut self,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Result<(), SurfaceError> {
        self.validate(palette, &world_from_model)?;
        let world_from_model = world_from_model.normalized();
        if world_from_model == self.world_from_model {
            std::mem::swap(&mut self.palette, &mut self.previous_palette);
        } else {
            let now_from_before = world_from_model.relative(&self.world_from_model);
            let moved = |before: &Affine| Affine::from_f64(&(now_from_before * before.to_f64()));
            if let Some(joint) = self.palette.iter().position(|m| !self.keeps(&moved(m))) {
                return Err(SurfaceError::Palette(JointId(joint as u32)));
            }
            for (previous, before) in self.previous_palette.iter_mut().zip(&self.palette) {
                *previous = moved(before);
            }
        }
        self.pose(palette, world_from_model)
    }

    /// Puts the surface somewhere without motion: the given pose becomes current and previous. For
    /// the first tick, a teleport, and waking up.
    ///
    /// # Errors
    /// As [`SkinnedSurface::advance`].
    pub fn place(
        &mut self,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Result<(), SurfaceError> {
        self.validate(palette, &world_from_model)?;
        self.previous_palette.copy_from_slice(palette.matrices());
        self.pose(palette, world_from_model.normalized())
    }

    /// The shared rest data.
    pub fn mesh(&self) -> &Arc<ColliderMesh> {
        &self.mesh
    }

    /// Where the creature stands now.
    pub fn world_from_model(&self) -> &Similarity {
        &self.world_from_model
    }

    /// Every vertex as skinned this tick, in model space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Where a vertex stood a tick ago, in the current model frame; `None` if it is out of range.
    pub fn previous_position(&self, vertex: VertexId) -> Option<Vec3> {
        (vertex.index() < self.mesh.positions().len())
            .then(|| skin_vertex(&self.mesh, &self.previous_palette, vertex.index()))
    }

    /// The bounding sphere of a part as refitted this tick, in model space; `None` for a part that
    /// does not exist or has no triangles left.
    pub fn part_sphere(&self, part: PartId) -> Option<Sphere> {
        self.spheres.get(part.index()).copied().flatten()
    }

    /// The corners of a triangle as skinned this tick.
    pub(super) fn corners(&self, triangle: TriangleId) -> [Vec3; 3] {
        self.mesh.triangles()[triangle.index()].map(|v| self.positions[v.index()])
    }

    /// The corners of a triangle a tick ago, in the current model frame.
    pub(super) fn previous_corners(&self, triangle: TriangleId) -> [Vec3; 3] {
        self.mesh.triangles()[triangle.index()]
            .map(|v| skin_vertex(&self.mesh, &self.previous_palette, v.index()))
    }

    /// Makes a pose current; everything was checked before.
    fn pose(
        &mut self,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Result<(), SurfaceError> {
        self.palette.copy_from_slice(palette.matrices());
        self.world_from_model = world_from_model;
        skin_into(&self.mesh, &self.palette, &mut self.positions)?;
        self.refit();
        Ok(())
    }

    /// Brings the sphere and mirror flag of one part, which may be a new last one, up to date.
    pub(super) fn refit_part(&mut self, part: PartId) {
        let index = part.index();
        let part = &self.mesh.parts()[index];
        self.spheres.resize(self.mesh.parts().len(), None);
        self.mirrored.resize(self.mesh.parts().len(), false);
        self.spheres[index] = part_sphere(part, &self.positions);
        self.mirrored[index] = self.palette[part.joint.0 as usize].is_mirrored();
    }

    /// Brings all spheres and mirror flags up to the current pose.
    fn refit(&mut self) {
        refit_part_spheres(&self.mesh, &self.positions, &mut self.spheres);
        self.mirrored.clear();
        let parts = self.mesh.parts().iter();
        self.mirrored
            .extend(parts.map(|part| self.palette[part.joint.0 as usize].is_mirrored()));
    }

    fn validate(
        &self,
        palette: &Palette,
        world_from_model: &Similarity,
    ) -> Result<(), SurfaceError> {
        let matrices = palette.matrices();
        if matrices.len() != self.mesh.joint_count() {
            return Err(SurfaceError::JointCount {
                expected: self.mesh.joint_count(),
                found: matrices.len(),
            });
        }
        if let Some(joint) = matrices.iter().position(|m| !self.keeps(m)) {
            return Err(SurfaceError::Palette(JointId(joint as u32)));
        }
        if !world_from_model.is_valid() {
            return Err(SurfaceError::WorldFromModel);
        }
        Ok(())
    }

    /// True if a matrix keeps every vertex within 2^100 of the origin; false for NaN.
    fn keeps(&self, matrix: &Affine) -> bool {
        matrix.reach(f64::from(self.mesh.radius())) <= MAX_COORDINATE
    }
}

#[cfg(test)]
mod tests;
