use glam::Vec3;
use parry3d::bounding_volume::Aabb;
use parry3d::shape::{TriMesh, TriMeshFlags};

use crate::surface::{Patch, PatchChange, SkinnedSurface, SurfaceError};

/// A [`Patch`] as a mesh of parry's, in model space at the current pose; the mesh is kept from tick to
/// tick, and only refitted while its triangles stay the same.
///
/// Triangle i of the mesh is `patch().triangles()[i]` of the surface; the same holds for vertices.
///
/// ```
/// # use std::sync::Arc;
/// # use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
/// # use clamber_surface::rig::JointId;
/// # use clamber_surface::surface::SkinnedSurface;
/// # use glam::Vec3;
/// use clamber_surface::parry::SurfacePatch;
/// use clamber_surface::parry::parry3d::bounding_volume::Aabb;
/// # let source = MeshSource {
/// #     positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
/// #     triangles: &[[0, 1, 2]],
/// #     influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
/// #     joint_count: 1,
/// #     ..MeshSource::default()
/// # };
/// # let surface = SkinnedSurface::new(Arc::new(ColliderMesh::build(&source, &BuildOptions::default())?.0));
///
/// let mut patch = SurfacePatch::default();
/// patch.update(&surface, &Aabb::new(Vec3::splat(-1.0), Vec3::ONE), 0.5)?;
/// assert_eq!(patch.mesh().map(|mesh| mesh.num_triangles()), Some(1));
/// assert!(patch.patch().velocities(1.0 / 60.0).all(|velocity| velocity == Vec3::ZERO));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SurfacePatch {
    patch: Patch,
    mesh: Option<TriMesh>,
}

impl SurfacePatch {
    /// [`Patch::update`] with the triangles near a box, and their mesh.
    ///
    /// # Errors
    /// As [`Patch::update`]; nothing is changed then.
    pub fn update(
        &mut self,
        surface: &SkinnedSurface,
        near: &Aabb,
        margin: f32,
    ) -> Result<PatchChange, SurfaceError> {
        let change = self.patch.update(surface, near.mins, near.maxs, margin)?;
        let place = |vertex: usize| self.patch.positions()[vertex];
        match &mut self.mesh {
            Some(mesh) if change != PatchChange::Rebuilt => move_trimesh(mesh, place),
            mesh => *mesh = trimesh(&self.patch, TriMeshFlags::DEFORMABLE, place),
        }
        Ok(change)
    }

    /// The mesh; `None` without triangles, since parry has none such.
    pub fn mesh(&self) -> Option<&TriMesh> {
        self.mesh.as_ref()
    }

    /// What the mesh is made of: ids, and positions a tick ago.
    pub fn patch(&self) -> &Patch {
        &self.patch
    }
}

/// A patch as a mesh, its vertices wherever `place` puts them; `None` without triangles.
///
/// Flags that would change vertices or triangles, as merging does where vertices coincide, are left
/// out with all that depends on them: the mesh has the patch's own.
pub fn trimesh(
    patch: &Patch,
    flags: TriMeshFlags,
    place: impl Fn(usize) -> Vec3,
) -> Option<TriMesh> {
    let with = |flags: TriMeshFlags| {
        let vertices = (0..patch.vertices().len()).map(&place).collect();
        let mesh = TriMesh::with_flags(vertices, patch.indices().to_vec(), flags).ok()?;
        let same = mesh.vertices().len() == patch.vertices().len();
        (same && mesh.indices() == patch.indices()).then_some(mesh)
    };
    with(flags).or_else(|| with(flags & TriMeshFlags::DEFORMABLE))
}

/// Puts the vertices of such a mesh elsewhere, and refits its tree.
pub fn move_trimesh(mesh: &mut TriMesh, place: impl Fn(usize) -> Vec3) {
    mesh.update_vertices(|vertices| {
        for (index, vertex) in vertices.iter_mut().enumerate() {
            *vertex = place(index);
        }
    });
}

#[cfg(test)]
mod tests;
