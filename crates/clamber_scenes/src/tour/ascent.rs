//! Shortest ways from everywhere on a creature to its top.

use std::collections::BTreeSet;

use clamber_surface::mesh::VertexId;
use glam::Vec3;

use super::Ways;
use crate::Creature;

/// For every vertex the next vertex on the shortest way to the creature's top, at rest.
///
/// The top is the largest level patch of the head. On a creature without level skin on a joint called head it is the
/// highest level skin.
#[derive(Clone, Debug)]
pub struct Ascent {
    next: Vec<Option<VertexId>>,
    /// Length of the way along edges, in the file's metres; infinite where no way leads to the top.
    left: Vec<f32>,
    feet: Vec<VertexId>,
}

/// Skin is level if the upward component of its normal is above this: a slope below 32 degrees.
const LEVEL: f32 = 0.85;

/// Without a head, level skin this far below the highest counts as the top, as a share of the creature's height.
const TOP: f32 = 0.03;

impl Ascent {
    /// The ascent along `ways`, which must be of the same creature.
    pub fn new(creature: &Creature, ways: &Ways) -> Self {
        Self::to(ways, &crown(creature, ways))
    }

    /// Ways to other places than the top: to the nearest of these vertices.
    pub fn to(ways: &Ways, places: &[u32]) -> Self {
        let (next, left) = ways.tree(places);
        let leads_up = |vertex: &&u32| left[**vertex as usize].is_finite();
        let feet = ways.feet().iter().filter(leads_up);
        Self {
            feet: feet.map(|vertex| VertexId(*vertex)).collect(),
            next: next.iter().map(|next| next.map(VertexId)).collect(),
            left,
        }
    }

    /// The next vertex on the way; `None` at the top, and where no way leads to it.
    pub fn next(&self, vertex: VertexId) -> Option<VertexId> {
        *self.next.get(vertex.index())?
    }

    /// Length of the way from a vertex to the top, in the units of the creature's file; infinite if there is none.
    pub fn left(&self, vertex: VertexId) -> f32 {
        let left = self.left.get(vertex.index());
        left.copied().unwrap_or(f32::INFINITY)
    }

    /// True if there is any way.
    pub fn leads_anywhere(&self) -> bool {
        !self.feet.is_empty()
    }

    /// Vertices near the ground from which a way leads to the top.
    pub fn feet(&self) -> &[VertexId] {
        &self.feet
    }

    /// All vertices from which a way leads to the top.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> {
        let leads_up = |vertex: &u32| self.left[*vertex as usize].is_finite();
        (0..self.left.len() as u32).filter(leads_up).map(VertexId)
    }
}

/// The vertices of the top: see [`Ascent`].
fn crown(creature: &Creature, ways: &Ways) -> Vec<u32> {
    let mesh = &creature.collider;
    let joints = creature.skeleton.joints();
    let is_head = |vertex: &u32| {
        let most = mesh
            .influences(VertexId(*vertex))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let joint = most.and_then(|(joint, _)| joints.get(joint.0 as usize));
        joint.is_some_and(|joint| joint.name.to_lowercase().contains("head"))
    };
    let rest = ways.rest();
    let mut normals = vec![Vec3::ZERO; rest.len()];
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|vertex| rest[vertex.index()]);
        for vertex in corners {
            normals[vertex.index()] += (b - a).cross(c - a);
        }
    }
    let is_level = |vertex: &u32| normals[*vertex as usize].normalize_or_zero().y > LEVEL;
    let level: Vec<u32> = ways.used().filter(is_level).collect();
    let head: Vec<u32> = level.iter().copied().filter(is_head).collect();
    if head.is_empty() {
        let height = |vertex: &u32| rest[*vertex as usize].y;
        let top = level.iter().map(height).fold(f32::NEG_INFINITY, f32::max);
        let low = rest.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        let high = level.iter().copied();
        return high
            .filter(|vertex| height(vertex) >= top - TOP * (top - low))
            .collect();
    }
    largest_patch(&head, ways)
}

/// The largest connected patch of some vertices.
fn largest_patch(vertices: &[u32], ways: &Ways) -> Vec<u32> {
    let mut left: BTreeSet<u32> = vertices.iter().copied().collect();
    let mut largest = Vec::new();
    while let Some(first) = left.pop_first() {
        let mut patch = vec![first];
        let mut next = 0;
        while next < patch.len() {
            let around = ways.neighbours(patch[next]).iter().copied();
            patch.extend(around.filter(|other| left.remove(other)));
            next += 1;
        }
        if patch.len() > largest.len() {
            largest = patch;
        }
    }
    largest
}
