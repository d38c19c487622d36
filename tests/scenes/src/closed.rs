//! Whether a mesh is closed, and the volume that it encloses.

use std::collections::HashMap;

use clamber_surface::mesh::{ColliderMesh, VertexId};

/// Defects that keep a mesh from being a closed manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flaws {
    /// Edges whose triangles do not pair off in opposite directions: 0 for a closed mesh.
    pub open_edges: usize,
    /// Edges with more than two triangles: 0 for a manifold.
    pub crowded_edges: usize,
}

/// Counts the flaws of a mesh.
pub fn flaws(mesh: &ColliderMesh) -> Flaws {
    let mut shared: HashMap<[u32; 2], (u32, i32)> = HashMap::new();
    for corners in mesh.triangles() {
        for k in 0..3 {
            let (a, b) = (corners[k].0, corners[(k + 1) % 3].0);
            let edge = shared.entry([a.min(b), a.max(b)]).or_default();
            edge.0 += 1;
            edge.1 += if a < b { 1 } else { -1 };
        }
    }
    Flaws {
        open_edges: shared.values().filter(|edge| edge.1 != 0).count(),
        crowded_edges: shared.values().filter(|edge| edge.0 > 2).count(),
    }
}

/// The volume that a closed mesh encloses at rest, in cubic units of mesh space. Negative if its triangles face
/// inwards.
pub fn volume(mesh: &ColliderMesh) -> f64 {
    let corner = |v: VertexId| mesh.positions()[v.index()].as_dvec3();
    let six_volumes = mesh.triangles().iter().map(|t| {
        let [a, b, c] = t.map(corner);
        a.dot(b.cross(c))
    });
    six_volumes.sum::<f64>() / 6.0
}
