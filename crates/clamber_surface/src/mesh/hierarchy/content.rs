//! What a node keeps of a child: rest data of a set of vertices.

use glam::Vec3;

use super::intervals::{Range, union};
use crate::geometry::{Sphere, widen};
use crate::mesh::clusters::{Cluster, Clusters, ROW};
use crate::rig::JointId;

/// So many points of a large set give the centre of its ball; all of them give the radius.
const CENTER_SAMPLE: usize = 1024;

/// Rest data of a set of vertices, at least one.
pub(super) struct Content {
    pub(super) ball: Sphere,
    /// Largest distance from the mesh's origin.
    pub(super) reach: f64,
    /// Most influences of one vertex.
    pub(super) influences: usize,
    pub(super) ranges: Vec<Range>,
}

impl Content {
    /// Of the vertices of one cluster, which stand at `points`.
    pub(super) fn of_cluster(clusters: &Clusters, cluster: &Cluster, points: &[Vec3]) -> Self {
        let rest = cluster.rest(clusters).chunks(3 + cluster.joints as usize);
        let mut influences = vec![0; points.len()];
        let joints = cluster.first_joint as usize..;
        let joints = &clusters.joints[joints][..cluster.joints as usize];
        let range = |(place, joint): (usize, &u32)| {
            let rows = rest.clone().map(|rows| rows[3 + place]);
            let weights = rows.flat_map(|row| row.0).take(points.len());
            let (mut low, mut high) = (1.0f32, 0.0f32);
            for (count, weight) in influences.iter_mut().zip(weights) {
                low = low.min(weight);
                high = high.max(weight);
                *count += usize::from(weight > 0.0);
            }
            (JointId(*joint), low, high)
        };
        let ranges = joints.iter().enumerate().map(range).collect();
        Self {
            ball: ball(points),
            reach: reach(points),
            influences: influences.into_iter().max().unwrap_or(0),
            ranges,
        }
    }

    /// Of the children of a node, whose vertices stand at `points`.
    pub(super) fn of_node(children: &[Self], points: &[Vec3]) -> Self {
        let influences = children.iter().map(|c| c.influences);
        Self {
            ball: ball(points),
            reach: children.iter().map(|c| c.reach).fold(0.0, f64::max),
            influences: influences.max().unwrap_or(0),
            ranges: union(children.iter().map(|c| &c.ranges[..])),
        }
    }
}

/// Holds all points.
fn ball(points: &[Vec3]) -> Sphere {
    let stride = points.len().div_ceil(CENTER_SAMPLE).max(1);
    let sample = points.iter().copied().step_by(stride);
    match Sphere::nearly_smallest(sample) {
        Some(ball) if stride == 1 => ball,
        near => {
            let center = near.map_or(Vec3::ZERO, |ball| ball.center);
            Sphere::around(center, points.iter().copied())
        }
    }
}

fn reach(points: &[Vec3]) -> f64 {
    let squares = points.iter().map(|p| widen(*p).length_squared());
    squares.fold(0.0, f64::max).sqrt() * (1.0 + 1e-15)
}

/// The rest positions of all slots, cluster by cluster, and where those of each start.
pub(super) struct Points {
    pub(super) positions: Vec<Vec3>,
    pub(super) starts: Vec<usize>,
}

impl Points {
    pub(super) fn of(clusters: &Clusters) -> Self {
        let (mut positions, mut starts) = (Vec::new(), vec![0]);
        for cluster in &clusters.clusters {
            let (rest, of_row) = (cluster.rest(clusters), 3 + cluster.joints as usize);
            for slot in 0..usize::from(cluster.slots) {
                let axis = |axis: usize| rest[slot / ROW * of_row + axis].0[slot % ROW];
                positions.push(Vec3::new(axis(0), axis(1), axis(2)));
            }
            starts.push(positions.len());
        }
        Self { positions, starts }
    }
}
