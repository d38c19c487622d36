//! Eager evaluation: computes all positions and bounds before they are requested.

use super::PosedMesh;
use crate::bounds::Spheres;
use crate::mesh::ColliderMesh;
use crate::mesh::clusters::ROW;
use crate::mesh::hierarchy::Child;
use crate::skin::ClusterPositions;

impl PosedMesh {
    /// Skins every cluster and fits every bound to the skinned positions, children before parents.
    pub(crate) fn fill(&mut self, mesh: &ColliderMesh) {
        let nodes = &mesh.hierarchy().nodes;
        for (index, node) in nodes.iter().enumerate().rev() {
            let mut spheres = Spheres::ZERO;
            for lane in 0..usize::from(node.lanes) {
                let sphere = match node.child(lane) {
                    Child::Cluster(cluster) => self.fill_cluster(mesh, cluster as usize),
                    Child::Node(child) => self.nodes.peek(child as usize).map(|spheres| {
                        around_spheres(spheres, usize::from(nodes[child as usize].lanes))
                    }),
                };
                let sphere = sphere.unwrap_or(EMPTY);
                for (row, number) in spheres.rows_mut().into_iter().zip(sphere) {
                    row[lane] = number;
                }
            }
            self.nodes.fill_ahead(index, |found| *found = spheres);
        }
    }

    /// Skins a cluster and returns a sphere around it; `None` if it is dead.
    fn fill_cluster(&mut self, mesh: &ColliderMesh, index: usize) -> Option<[f32; 4]> {
        let clusters = mesh.clusters();
        let cluster = &clusters.clusters[index];
        if cluster.is_dead() {
            return None;
        }
        let mut sphere = EMPTY;
        let (level, palette) = (self.level, &self.palette);
        self.clusters.fill_ahead(index, |found| {
            found.skin(level, clusters, cluster, palette);
            sphere = around_positions(&found.positions, cluster.rows() * ROW);
        });
        Some(sphere)
    }
}

/// An empty sphere, for a dead cluster and for a node that has only dead ones below it. It enlarges no other
/// sphere.
const EMPTY: [f32; 4] = [0.0, 0.0, 0.0, f32::NEG_INFINITY];

/// Adds to a radius what rounding in f32 may have taken off: some eight roundings of 2^-24, and squares that
/// underflow.
fn rounded_up(radius: f32) -> f32 {
    radius * (1.0 + 8.0 * f32::EPSILON) + LEAST_RADIUS
}

/// 2^-56, the same as in the bounds from the palette.
const LEAST_RADIUS: f32 = 1.0 / (1u64 << 56) as f32;

/// How many numbers are processed at once.
const WIDTH: usize = 8;

/// The lowest and the highest of some numbers. Their count must be a positive multiple of [`WIDTH`].
fn range(numbers: &[f32]) -> (f32, f32) {
    let (mut low, mut high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
    for chunk in numbers.as_chunks::<WIDTH>().0 {
        for k in 0..WIDTH {
            low[k] = if chunk[k] < low[k] { chunk[k] } else { low[k] };
            high[k] = if chunk[k] > high[k] {
                chunk[k]
            } else {
                high[k]
            };
        }
    }
    let least = low.into_iter().fold(f32::INFINITY, f32::min);
    let most = high.into_iter().fold(f32::NEG_INFINITY, f32::max);
    (least, most)
}

/// A sphere about the middle of the box of some positions: x, y, z, radius.
fn around_positions(positions: &ClusterPositions, count: usize) -> [f32; 4] {
    let [x, y, z] = &positions.0;
    let center = [x, y, z].map(|numbers| {
        let (low, high) = range(&numbers[..count]);
        low * 0.5 + high * 0.5
    });
    let mut farthest = [0.0; WIDTH];
    for first in (0..count).step_by(WIDTH) {
        for (k, farthest) in farthest.iter_mut().enumerate() {
            let dx = x[first + k] - center[0];
            let dy = y[first + k] - center[1];
            let dz = z[first + k] - center[2];
            let distance = dx * dx + dy * dy + dz * dz;
            *farthest = if distance > *farthest {
                distance
            } else {
                *farthest
            };
        }
    }
    let farthest = farthest.into_iter().fold(0.0, f32::max).sqrt();
    [center[0], center[1], center[2], rounded_up(farthest)]
}

/// A sphere about the middle of the box of some spheres; [`EMPTY`] if all of them are empty.
fn around_spheres(spheres: &Spheres, count: usize) -> [f32; 4] {
    let center = [&spheres.x, &spheres.y, &spheres.z].map(|numbers| {
        let ends = numbers.iter().zip(&spheres.radius).take(count);
        let (low, high) = ends.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), (x, r)| {
            (low.min(x - r), high.max(x + r))
        });
        let middle = low * 0.5 + high * 0.5;
        // The centre of an infinite or empty sphere does not matter, but it must not be NaN.
        if middle.is_finite() { middle } else { 0.0 }
    });
    let reach = |lane: usize| {
        let dx = spheres.x[lane] - center[0];
        let dy = spheres.y[lane] - center[1];
        let dz = spheres.z[lane] - center[2];
        (dx * dx + dy * dy + dz * dz).sqrt() + spheres.radius[lane]
    };
    let farthest = (0..count).map(reach).fold(f32::NEG_INFINITY, f32::max);
    [center[0], center[1], center[2], rounded_up(farthest)]
}
