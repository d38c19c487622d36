//! Ways over a creature: the shortest ones along its edges at rest (Dijkstra 1959).

use clamber_surface::mesh::VertexId;
use glam::Vec3;
use pathfinding::directed::dijkstra::dijkstra;
use pathfinding::undirected::connected_components::components;

use crate::{Creature, SceneError};

/// Separate pieces of skin are joined by ways where they are nearer than this share of the creature's height.
const GAP: f32 = 0.04;

/// Lengths of ways are counted in so many steps per height of the creature.
const STEPS: f32 = 1e8;

/// All ways over a creature: a graph of vertices.
#[derive(Clone, Debug)]
pub struct Ways {
    rest: Vec<Vec3>,
    height: f32,
    neighbours: Vec<Vec<u32>>,
    feet: Vec<u32>,
    heads: Vec<u32>,
}

impl Ways {
    /// All ways over a creature, at rest.
    pub fn new(creature: &Creature) -> Result<Self, SceneError> {
        let rest = creature.at_rest()?;
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); rest.len()];
        for corners in creature.rig.collider.triangles() {
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
        let height = heights.fold(f32::NEG_INFINITY, f32::max) - low;
        let among = |from: f32, to: f32| {
            let share = |v: &u32| (rest[*v as usize].y - low) / height;
            let within = used.iter().filter(|v| (from..=to).contains(&share(v)));
            within.copied().collect()
        };
        let (feet, heads) = (among(0.02, 0.15), among(0.93, 1.0));
        let groups = neighbours.iter().zip(0..);
        let groups: Vec<Vec<u32>> = groups.map(|(all, v)| [&all[..], &[v]].concat()).collect();
        let mut piece = vec![0; rest.len()];
        for (index, group) in components(&groups).iter().enumerate() {
            group.iter().for_each(|v| piece[*v as usize] = index);
        }
        for (index, &a) in used.iter().enumerate() {
            for &b in &used[index + 1..] {
                let apart = rest[a as usize].distance(rest[b as usize]);
                if piece[a as usize] != piece[b as usize] && apart < GAP * height {
                    neighbours[a as usize].push(b);
                    neighbours[b as usize].push(a);
                }
            }
        }
        Ok(Self {
            rest,
            height,
            neighbours,
            feet,
            heads,
        })
    }

    /// A shortest way from a vertex near the ground to one near the top, both chosen by a seed. `None` if 50 such
    /// choices find no connected pair. Consecutive vertices share an edge, or lie on both sides of a gap between two
    /// pieces of skin.
    pub fn climb(&self, seed: u64) -> Option<Vec<VertexId>> {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut one_of =
            |vertices: &[u32]| vertices.get(rng.usize(0..vertices.len().max(1))).copied();
        (0..50).find_map(|_| {
            let (foot, head) = (one_of(&self.feet)?, one_of(&self.heads)?);
            let next = |from: &u32| {
                let from = *from as usize;
                self.neighbours[from].iter().map(move |to| {
                    let length = self.rest[from].distance(self.rest[*to as usize]);
                    (*to, (length / self.height * STEPS) as u64)
                })
            };
            let (waypoints, _) = dijkstra(&foot, next, |vertex| *vertex == head)?;
            Some(waypoints.into_iter().map(VertexId).collect())
        })
    }
}
