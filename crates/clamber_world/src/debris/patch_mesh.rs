//! A skin patch as a parry mesh.

use clamber_surface::surface::Patch;
use rapier3d::geometry::TriMesh;
use rapier3d::math::Vector;
use rapier3d::parry::shape::TriMeshFlags;

/// A patch as a mesh, with its vertices where `place` puts them; `None` without triangles.
///
/// The mesh has the patch's own vertices and triangles. If the flags would change these, for example by merging
/// coincident vertices, only the flags within [`TriMeshFlags::DEFORMABLE`] are used.
pub(super) fn trimesh(
    patch: &Patch,
    flags: TriMeshFlags,
    place: impl Fn(usize) -> Vector,
) -> Option<TriMesh> {
    let with = |flags: TriMeshFlags| {
        let vertices = (0..patch.vertices().len()).map(&place).collect();
        let mesh = TriMesh::with_flags(vertices, patch.indices().to_vec(), flags).ok()?;
        let same = mesh.vertices().len() == patch.vertices().len();
        (same && mesh.indices() == patch.indices()).then_some(mesh)
    };
    with(flags).or_else(|| with(flags & TriMeshFlags::DEFORMABLE))
}

/// Moves the vertices of such a mesh, and refits its tree.
pub(super) fn move_trimesh(mesh: &mut TriMesh, place: impl Fn(usize) -> Vector) {
    mesh.update_vertices(|vertices| {
        for (index, vertex) in vertices.iter_mut().enumerate() {
            *vertex = place(index);
        }
    });
}
