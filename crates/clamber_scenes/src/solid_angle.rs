//! Is a point inside a mesh? By the solid angle that the mesh covers as seen from it. Over all triangles, with none of
//! the library's own queries, so that it can judge them.

pub use clamber_surface::measure::winding_number;
use clamber_surface::mesh::ColliderMesh;
use glam::{DVec3, Vec3};

/// True if the mesh winds around `p` more than half.
pub fn is_inside(positions: &[Vec3], mesh: &ColliderMesh, p: DVec3) -> bool {
    winding_number(positions, mesh, p) > 0.5
}
