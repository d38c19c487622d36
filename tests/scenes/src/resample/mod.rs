//! A mesh with more or fewer vertices: the same creature at any size, for benches.

mod coarsen;
mod refine;

use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshError, MeshSource, SurfaceTag, VertexId,
    normalize_influences,
};
use glam::DVec3;

/// The mesh with about so many vertices: the longest edges are halved until there are enough, or the
/// shortest ones collapsed until there are few enough.
///
/// More vertices than asked for remain if every further collapse would flip a triangle or break the
/// manifold. Points without a triangle are dropped.
///
/// # Errors
/// [`MeshError`] if no usable triangle is left, which takes a mesh of very few triangles.
pub fn resample(mesh: &ColliderMesh, vertices: usize) -> Result<ColliderMesh, MeshError> {
    let mut pieces = Pieces::of(mesh);
    if vertices > pieces.points.len() {
        refine::refine(&mut pieces, vertices);
    } else {
        coarsen::coarsen(&mut pieces, vertices);
    }
    pieces.build(mesh.joint_count())
}

/// A mesh as plain points and triangles, for editing.
struct Pieces {
    points: Vec<Point>,
    triangles: Vec<Triangle>,
}

/// A vertex.
#[derive(Clone)]
struct Point {
    position: DVec3,
    influences: Vec<Influence>,
}

#[derive(Clone, Copy)]
struct Triangle {
    corners: [u32; 3],
    tag: SurfaceTag,
}

impl Point {
    /// The point half way between two points, in position and in influences.
    fn between(a: &Self, b: &Self) -> Self {
        let all = [a.influences.as_slice(), &b.influences].concat();
        Self {
            position: (a.position + b.position) * 0.5,
            // Both lists were normalised, so their sum is not zero.
            influences: normalize_influences(&all).unwrap_or(all),
        }
    }
}

/// An edge as two point indices, the smaller one first.
type Edge = [u32; 2];

fn edge(a: u32, b: u32) -> Edge {
    if a < b { [a, b] } else { [b, a] }
}

impl Pieces {
    fn of(mesh: &ColliderMesh) -> Self {
        let point = |(index, position): (usize, &glam::Vec3)| Point {
            position: position.as_dvec3(),
            influences: mesh
                .influences(VertexId(index as u32))
                .map(|(joint, weight)| Influence { joint, weight })
                .collect(),
        };
        let triangles = mesh.triangles().iter().zip(mesh.tags().iter());
        Self {
            points: mesh.positions().iter().enumerate().map(point).collect(),
            triangles: triangles
                .map(|(corners, tag)| Triangle {
                    corners: corners.map(|v| v.0),
                    tag: *tag,
                })
                .collect(),
        }
    }

    /// Squared length of an edge, as the bits of an f64: for numbers of at least 0 these sort like the numbers.
    fn length(&self, [a, b]: Edge) -> u64 {
        let (a, b) = (&self.points[a as usize], &self.points[b as usize]);
        a.position.distance_squared(b.position).to_bits()
    }

    /// The mesh of all triangles, and of the points that they use.
    fn build(&self, joint_count: usize) -> Result<ColliderMesh, MeshError> {
        let mut number = vec![u32::MAX; self.points.len()];
        let (mut positions, mut influences, mut influence_ends) = (vec![], vec![], vec![]);
        let mut triangles = Vec::with_capacity(self.triangles.len());
        for triangle in &self.triangles {
            triangles.push(triangle.corners.map(|corner| {
                let index = corner as usize;
                if number[index] == u32::MAX {
                    number[index] = positions.len() as u32;
                    positions.push(self.points[index].position.as_vec3());
                    influences.extend_from_slice(&self.points[index].influences);
                    influence_ends.push(influences.len() as u32);
                }
                number[index]
            }));
        }
        let tags: Vec<SurfaceTag> = self.triangles.iter().map(|t| t.tag).collect();
        let source = MeshSource {
            positions: &positions,
            triangles: &triangles,
            influences: &influences,
            influence_ends: &influence_ends,
            tags: &tags,
            joint_count,
            ..MeshSource::default()
        };
        Ok(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0)
    }
}
