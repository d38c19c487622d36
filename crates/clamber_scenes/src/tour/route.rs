//! The shortest way over a mesh, along its edges at rest (Dijkstra 1959).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use clamber_surface::mesh::{ColliderMesh, VertexId};
use glam::Vec3;

/// A way over a creature, from vertex to vertex.
#[derive(Clone, Debug)]
pub struct Route {
    /// Along edges, from the first to the last.
    pub waypoints: Vec<VertexId>,
}

/// A vertex on the way, nearest first.
struct Open {
    distance: f32,
    vertex: u32,
}

impl Route {
    /// From one vertex to another, at rest; `None` where the mesh does not connect them.
    pub fn between(
        mesh: &ColliderMesh,
        positions: &[Vec3],
        from: VertexId,
        to: VertexId,
    ) -> Option<Self> {
        let mut edges: Vec<Vec<u32>> = vec![Vec::new(); positions.len()];
        for corners in mesh.triangles() {
            for k in 0..3 {
                edges[corners[k].index()].push(corners[(k + 1) % 3].0);
                edges[corners[(k + 1) % 3].index()].push(corners[k].0);
            }
        }
        let mut best = vec![f32::INFINITY; positions.len()];
        let mut before = vec![u32::MAX; positions.len()];
        let mut open = BinaryHeap::new();
        best[from.index()] = 0.0;
        open.push(Open {
            distance: 0.0,
            vertex: from.0,
        });
        while let Some(Open { distance, vertex }) = open.pop() {
            if distance > best[vertex as usize] {
                continue;
            }
            for &other in &edges[vertex as usize] {
                let edge = positions[vertex as usize].distance(positions[other as usize]);
                if distance + edge < best[other as usize] {
                    best[other as usize] = distance + edge;
                    before[other as usize] = vertex;
                    open.push(Open {
                        distance: distance + edge,
                        vertex: other,
                    });
                }
            }
        }
        let mut waypoints = vec![to];
        let mut vertex = to.0;
        while vertex != from.0 {
            vertex = before[vertex as usize];
            if vertex == u32::MAX {
                return None;
            }
            waypoints.push(VertexId(vertex));
        }
        waypoints.reverse();
        Some(Self { waypoints })
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_distance = other.distance.total_cmp(&self.distance);
        by_distance.then_with(|| other.vertex.cmp(&self.vertex))
    }
}
