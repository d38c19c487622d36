//! Meshes of every family, with the joints that poses need.

use std::collections::HashMap;
use std::sync::Arc;

use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use clamber_surface::rig::JointId;
use glam::{DVec3, Vec3};

use super::MeshFamily;
use super::shapes::{ball, tube, tube_of_pairs};
use super::soups::{copied, slivers, spiked, with_t_junctions};

/// A mesh and its joints.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The mesh.
    pub mesh: Arc<ColliderMesh>,
    /// Positions of the joints at rest.
    pub(super) origins: Vec<DVec3>,
    /// True if each joint is the child of the one before; false if no joint has a parent.
    pub(super) is_chain: bool,
    /// Approximate size at rest in model units, without spikes.
    pub extent: f64,
}

/// The joints, and their influences on the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Joints {
    /// Six joints, along the axes of a ball.
    Star,
    /// A chain of this many joints along a tube.
    Chain(usize),
    /// A chain of this many joints along a tube. The middle joint has all weights.
    Middle(usize),
}

impl Subject {
    /// A mesh with about the given number of triangles, and the given extent in model units.
    pub fn new(family: MeshFamily, triangles: usize, extent: f64, seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let (shape, joints) = match family {
            MeshFamily::Ball => (ball(triangles), Joints::Star),
            MeshFamily::OneJoint => (ball(triangles), Joints::Middle(1)),
            MeshFamily::Limb => (tube(triangles), Joints::Chain(12)),
            MeshFamily::Chain => (tube(triangles), Joints::Chain(1_000)),
            MeshFamily::AllOnOne => (tube(triangles), Joints::Middle(12)),
            MeshFamily::SliverTube => {
                let gap = [1e-3, 1e-4, 1e-6][rng.usize(0..3)];
                (tube_of_pairs(triangles, gap), Joints::Chain(12))
            }
            MeshFamily::Slivers => (slivers(triangles, &mut rng), Joints::Star),
            MeshFamily::Copies => (copied(ball(triangles / 2), &mut rng), Joints::Star),
            MeshFamily::Spikes => (spiked(ball(triangles), &mut rng), Joints::Star),
            MeshFamily::TJunctions => {
                let shape = with_t_junctions(ball(triangles * 3 / 4), &mut rng);
                (shape, Joints::Star)
            }
        };
        let origins: Vec<DVec3> = match joints {
            Joints::Star => STAR.map(|axis| axis * 0.25).to_vec(),
            Joints::Chain(count) | Joints::Middle(count) => (0..count)
                .map(|k| DVec3::Y * ((k as f64 + 0.5) / count as f64))
                .collect(),
        };
        let (mut influences, mut influence_ends) = (Vec::new(), Vec::new());
        for position in &shape.positions {
            match joints {
                Joints::Star => star(*position, &mut influences),
                Joints::Chain(count) => chain(position.y, count, &mut influences),
                Joints::Middle(count) => influences.push(influence(count / 2, 1.0)),
            }
            if family == MeshFamily::Copies && rng.u32(0..8) == 0 {
                // Cracks open along vertices that follow other joints.
                let start = influence_ends.last().map_or(0, |end| *end as usize);
                influences.truncate(start);
                influences.push(influence(rng.usize(0..6), 1.0));
            }
            influence_ends.push(influences.len() as u32);
        }
        let positions: Vec<Vec3> = shape
            .positions
            .iter()
            .map(|p| (*p * extent).as_vec3())
            .collect();
        let source = MeshSource {
            positions: &positions,
            triangles: &shape.triangles,
            influences: &influences,
            influence_ends: &influence_ends,
            joint_count: origins.len(),
            ..MeshSource::default()
        };
        let (mesh, _) = match ColliderMesh::build(&source, &ColliderBuildOptions::default()) {
            Ok(built) => built,
            Err(error) => panic!("{family}: {error}"),
        };
        let subject = Self {
            mesh: Arc::new(mesh),
            origins: origins.iter().map(|origin| *origin * extent).collect(),
            is_chain: !matches!(joints, Joints::Star),
            extent,
        };
        assert_eq!(is_closed(&subject.mesh), family.is_closed(), "{family}");
        subject
    }
}

/// The directions of the joints of [`Joints::Star`] from the centre.
const STAR: [DVec3; 6] = [
    DVec3::X,
    DVec3::NEG_X,
    DVec3::Y,
    DVec3::NEG_Y,
    DVec3::Z,
    DVec3::NEG_Z,
];

fn influence(joint: usize, weight: f64) -> Influence {
    Influence {
        joint: JointId(joint as u32),
        weight: weight as f32,
    }
}

/// Influences of the joints of [`Joints::Star`] whose axes are not on the far side of `position`.
fn star(position: DVec3, all: &mut Vec<Influence>) {
    let direction = position.normalize_or(DVec3::Y);
    let near = STAR.iter().map(|axis| axis.dot(direction) + 0.3);
    let near = near.enumerate().filter(|(_, near)| *near > 0.0);
    all.extend(near.map(|(joint, near)| influence(joint, near * near)));
}

/// Influences of the four nearest joints of a chain, or of all joints if the chain has fewer.
fn chain(height: f64, count: usize, all: &mut Vec<Influence>) {
    let along = height * count as f64 - 0.5;
    let first = (along.floor() as isize - 1).clamp(0, count.saturating_sub(4) as isize) as usize;
    for joint in first..(first + 4).min(count) {
        let distance = (joint as f64 - along).abs() / 2.5;
        let weight = (1.0 - distance * distance).max(0.0);
        all.push(influence(joint, weight * weight + 1e-6));
    }
}

/// True if every edge has exactly one triangle on either side.
fn is_closed(mesh: &ColliderMesh) -> bool {
    let mut balance: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for corners in mesh.triangles() {
        for k in 0..3 {
            let (a, b) = (corners[k].0, corners[(k + 1) % 3].0);
            let sides = balance.entry([a.min(b), a.max(b)]).or_default();
            sides[usize::from(a < b)] += 1;
        }
    }
    balance.values().all(|sides| *sides == [1, 1])
}
