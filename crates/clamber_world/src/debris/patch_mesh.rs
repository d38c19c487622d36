//! A patch of skin as a mesh of parry's.

use clamber_surface::surface::Patch;
use rapier3d::geometry::TriMesh;
use rapier3d::math::Vector;
use rapier3d::parry::shape::TriMeshFlags;

/// A patch as a mesh, its vertices wherever `place` puts them; `None` without triangles.
///
/// Flags that would change vertices or triangles, as merging does where vertices coincide, are left
/// out with all that depends on them: the mesh has the patch's own.
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

/// Puts the vertices of such a mesh elsewhere, and refits its tree.
pub(super) fn move_trimesh(mesh: &mut TriMesh, place: impl Fn(usize) -> Vector) {
    mesh.update_vertices(|vertices| {
        for (index, vertex) in vertices.iter_mut().enumerate() {
            *vertex = place(index);
        }
    });
}
