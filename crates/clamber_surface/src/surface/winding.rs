//! The winding number of a mesh around a point, from the solid angle: the oracle of [`ModelSpace::is_inside`].
//!
//! [`ModelSpace::is_inside`]: super::ModelSpace::is_inside

use glam::{DVec3, Vec3};

use crate::mesh::ColliderMesh;

/// How often a mesh winds around `point`: 1 inside a closed mesh, 0 outside, 2 where two closed pieces overlap; near
/// holes, values in between.
///
/// The solid angle of all triangles as seen from the point, over the solid angle of a sphere (van Oosterom and Strackee
/// 1983, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering 30(2)). `positions` are the
/// mesh's vertices, skinned, in the space of `point`. Triangles count whether enabled or not. It uses no query, so it
/// can judge them, and looks at every triangle.
pub fn winding_number(positions: &[Vec3], mesh: &ColliderMesh, point: DVec3) -> f64 {
    let triangles = mesh.triangles().iter();
    winding_of(
        triangles.map(|corners| corners.map(|v| positions[v.index()])),
        point,
    )
}

/// [`winding_number`] of triangles that are given by their corners.
pub fn winding_of(triangles: impl Iterator<Item = [Vec3; 3]>, point: DVec3) -> f64 {
    let covered: f64 = triangles
        .map(|corners| {
            let [a, b, c] = corners.map(|corner| corner.as_dvec3() - point);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let volume = a.dot(b.cross(c));
            let spread = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * libm::atan2(volume, spread)
        })
        .sum();
    covered / (4.0 * core::f64::consts::PI)
}
