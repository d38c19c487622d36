use glam::Vec3;

use crate::geometry::Affine;
use crate::mesh::{ColliderMesh, VertexId};

/// Skins one vertex by the contract, in plain scalar code. The palette must have as many matrices as the mesh has
/// joints.
#[inline]
pub(crate) fn skin_vertex(mesh: &ColliderMesh, palette: &[Affine], v: usize) -> Vec3 {
    let p = mesh.positions()[v];
    let mut sum = Vec3::ZERO;
    for (joint, weight) in mesh.influences(VertexId(v as u32)) {
        let moved = palette[joint.index()].transform_point(p);
        sum.x += weight * moved.x;
        sum.y += weight * moved.y;
        sum.z += weight * moved.z;
    }
    sum
}
