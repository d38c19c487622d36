//! Is a point inside a mesh? By the solid angle that the mesh covers as seen from it (van Oosterom
//! and Strackee 1983): a whole sphere from inside, nothing from outside. Over all triangles, with
//! none of the library's own queries, so that it can judge them.

use clamber_surface::mesh::ColliderMesh;
use glam::{DVec3, Vec3};

/// How often the mesh winds around `p`: 1 inside a closed mesh, 0 outside, in between near holes.
/// `positions` are the mesh's vertices as skinned; triangles count whether disabled or not.
pub fn winding_number(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> f64 {
    let triangles = mesh.triangles().iter();
    let covered: f64 = triangles
        .map(|corners| {
            let [a, b, c] = corners.map(|v| positions[v.index()].as_dvec3() - p);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let volume = a.dot(b.cross(c));
            let spread = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * libm::atan2(volume, spread)
        })
        .sum();
    covered / (4.0 * core::f64::consts::PI)
}

/// True if the mesh winds around `p` more than half.
pub fn is_inside(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> bool {
    winding_number(positions, mesh, p) > 0.5
}
