//! Whether a point is inside a mesh, by the solid angle that the mesh covers as seen from the point.
//!
//! It sums over all triangles and uses none of the library's queries, so that tests can judge them by it.

pub use clamber_surface::measure::winding_number;
use clamber_surface::measure::winding_of;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};

/// True if the mesh's winding number around `p` is above one half. `positions` are the mesh's vertices, posed or at
/// rest, in the space of `p`.
pub fn is_inside(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> bool {
    winding_number(positions, mesh, p) > 0.5
}

/// [`is_inside`] of the skin that queries see: without hidden triangles. `positions` are all its vertices.
pub fn is_inside_skin(positions: &[Vec3], surface: &SkinnedSurface, p: DVec3) -> bool {
    let all = (0..).map(TriangleId).zip(surface.mesh().triangles());
    let seen = all.filter(|(triangle, _)| surface.is_enabled(*triangle));
    let corners = seen.map(|(_, corners)| corners.map(|vertex| positions[vertex.index()]));
    winding_of(corners, p) > 0.5
}
