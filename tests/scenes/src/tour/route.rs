//! Ways over a creature: the shortest ones along its edges at rest (Dijkstra 1959).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use clamber_surface::mesh::{SurfaceTag, VertexId};
use glam::Vec3;

use crate::{Creature, CreatureError};

/// Separate pieces of skin are joined by ways where they are nearer than this share of the creature's height.
const GAP: f32 = 0.04;

/// A way over a creature, from vertex to vertex.
#[derive(Clone, Debug)]
pub struct Route {
    /// The vertices. Consecutive ones share an edge, or lie on both sides of a gap between two pieces of skin.
    pub waypoints: Vec<VertexId>,
}

/// All ways over a creature, or over its triangles with certain tags: a graph of vertices.
#[derive(Clone, Debug)]
pub struct Ways {
    rest: Vec<Vec3>,
    neighbours: Vec<Vec<u32>>,
    feet: Vec<u32>,
    heads: Vec<u32>,
}

/// An entry of Dijkstra's queue; the nearest vertex comes first.
struct Open {
    distance: f32,
    vertex: u32,
}

impl Ways {
    /// All ways over a creature, at rest.
    ///
    /// # Errors
    /// [`CreatureError`] if the rest pose does not fit the collider.
    pub fn new(creature: &Creature) -> Result<Self, CreatureError> {
        Self::over(creature, |_| true)
    }

    /// The ways over those triangles of a creature whose tag satisfies `is_way`, at rest.
    ///
    /// # Errors
    /// As [`Ways::new`].
    pub fn over(
        creature: &Creature,
        is_way: impl Fn(&SurfaceTag) -> bool,
    ) -> Result<Self, CreatureError> {
        let palette = creature.skeleton.palette(&creature.skeleton.rest_pose())?;
        let rest = clamber_surface::skin::skin(&creature.collider, palette.matrices())?;
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); rest.len()];
        let mesh = &creature.collider;
        for (corners, tag) in mesh.triangles().iter().zip(mesh.tags().iter()) {
            if !is_way(tag) {
                continue;
            }
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                neighbours[a.index()].push(b.0);
                neighbours[b.index()].push(a.0);
            }
        }
        let used = |v: &u32| !neighbours[*v as usize].is_empty();
        let used: Vec<u32> = (0..rest.len() as u32).filter(used).collect();
        let heights = used.iter().map(|v| rest[*v as usize].y);
        let low = heights.clone().fold(f32::INFINITY, f32::min);
        let high = heights.fold(f32::NEG_INFINITY, f32::max);
        let share = |v: u32| (rest[v as usize].y - low) / (high - low);
        let among = |from: f32, to: f32| {
            let within = used.iter().copied();
            within
                .filter(|v| (from..=to).contains(&share(*v)))
                .collect()
        };
        let (feet, heads) = (among(0.02, 0.15), among(0.93, 1.0));
        let piece = pieces(&neighbours);
        for (index, &a) in used.iter().enumerate() {
            for &b in &used[index + 1..] {
                let apart = rest[a as usize].distance(rest[b as usize]);
                if piece[a as usize] != piece[b as usize] && apart < GAP * (high - low) {
                    neighbours[a as usize].push(b);
                    neighbours[b as usize].push(a);
                }
            }
        }
        Ok(Self {
            rest,
            neighbours,
            feet,
            heads,
        })
    }

    /// A way from a vertex near the ground to one near the top, both chosen by a seed. `None` if 50 such choices find
    /// no connected pair.
    pub fn climb(&self, seed: u64) -> Option<Route> {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut one_of =
            |vertices: &[u32]| vertices.get(rng.usize(0..vertices.len().max(1))).copied();
        (0..50).find_map(|_| {
            let (foot, head) = (one_of(&self.feet)?, one_of(&self.heads)?);
            self.between(foot, head)
        })
    }

    fn between(&self, from: u32, to: u32) -> Option<Route> {
        let (before, _) = self.tree(&[from]);
        let mut waypoints = vec![VertexId(to)];
        let mut vertex = to;
        while vertex != from {
            vertex = before[vertex as usize]?;
            waypoints.push(VertexId(vertex));
        }
        waypoints.reverse();
        Some(Route { waypoints })
    }

    /// The shortest way to every vertex from the nearest of `from`: the vertex before it, and the length of the way.
    /// The length is infinite where no way leads.
    pub(super) fn tree(&self, from: &[u32]) -> (Vec<Option<u32>>, Vec<f32>) {
        let mut best = vec![f32::INFINITY; self.rest.len()];
        let mut before = vec![None; self.rest.len()];
        let mut open = BinaryHeap::new();
        for &vertex in from {
            best[vertex as usize] = 0.0;
            open.push(Open {
                distance: 0.0,
                vertex,
            });
        }
        while let Some(Open { distance, vertex }) = open.pop() {
            if distance > best[vertex as usize] {
                continue;
            }
            let here = self.rest[vertex as usize];
            for &other in &self.neighbours[vertex as usize] {
                let along = distance + here.distance(self.rest[other as usize]);
                if along < best[other as usize] {
                    best[other as usize] = along;
                    before[other as usize] = Some(vertex);
                    open.push(Open {
                        distance: along,
                        vertex: other,
                    });
                }
            }
        }
        (before, best)
    }
}

/// The piece of each vertex, named by the smallest vertex that edges connect it with.
fn pieces(neighbours: &[Vec<u32>]) -> Vec<u32> {
    let mut piece = vec![u32::MAX; neighbours.len()];
    let mut open = Vec::new();
    for first in 0..neighbours.len() as u32 {
        open.push(first);
        while let Some(vertex) = open.pop() {
            if piece[vertex as usize] == u32::MAX {
                piece[vertex as usize] = first;
                open.extend(&neighbours[vertex as usize]);
            }
        }
    }
    piece
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
