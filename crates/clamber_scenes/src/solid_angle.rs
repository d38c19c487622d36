//! Whether a point is inside a mesh, by the solid angle that the mesh covers as seen from the point.
//!
//! It sums over all triangles and uses none of the library's queries, so that tests can judge them by it.

pub use clamber_surface::measure::winding_number;
use clamber_surface::mesh::ColliderMesh;
use glam::{DVec3, Vec3};

/// True if the mesh's winding number around `p` is above one half. `positions` are the mesh's vertices, posed or at
/// rest, in the space of `p`.
pub fn is_inside(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> bool {
    winding_number(positions, mesh, p) > 0.5
}
