use glam::Vec3;

use crate::geometry::Affine;
use crate::mesh::ColliderMesh;
use crate::surface::SurfaceError;

/// Skins every vertex of a mesh.
///
/// # Errors
/// As [`skin_into`].
pub fn skin(mesh: &ColliderMesh, palette: &[Affine]) -> Result<Vec<Vec3>, SurfaceError> {
    let mut positions = Vec::new();
    skin_into(mesh, palette, &mut positions)?;
    Ok(positions)
}

/// [`skin`] into an existing vector, which keeps its memory. Positions come out in model space, in
/// vertex order, each vertex once.
///
/// # Errors
/// [`SurfaceError::JointCount`] if the palette has another number of matrices than the mesh has
/// joints. Matrices that are not finite give positions that are not finite.
pub fn skin_into(
    mesh: &ColliderMesh,
    palette: &[Affine],
    positions: &mut Vec<Vec3>,
) -> Result<(), SurfaceError> {
    if palette.len() != mesh.joint_count() {
        return Err(SurfaceError::JointCount {
            expected: mesh.joint_count(),
            found: palette.len(),
        });
    }
    positions.clear();
    positions.extend((0..mesh.positions().len()).map(|v| skin_vertex(mesh, palette, v)));
    Ok(())
}

/// One vertex by the contract. The palette must have as many matrices as the mesh has joints.
#[inline]
pub(crate) fn skin_vertex(mesh: &ColliderMesh, palette: &[Affine], v: usize) -> Vec3 {
    let p = mesh.positions()[v];
    let (joints, weights) = mesh.influence_slices(v);
    let mut sum = Vec3::ZERO;
    for (joint, weight) in joints.iter().zip(weights) {
        let moved = palette[*joint as usize].transform_point(p);
        sum.x += weight * moved.x;
        sum.y += weight * moved.y;
        sum.z += weight * moved.z;
    }
    sum
}
