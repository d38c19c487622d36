//! One pose of a surface, and what was computed of it on demand: bounds of nodes, skinned clusters.

mod cache;
mod whole;

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::Vec3;

use self::cache::Cache;
use super::bounds::{JointTable, RootBox, Spheres, spheres};
use crate::geometry::Affine;
use crate::mesh::ColliderMesh;
use crate::mesh::clusters::{Cluster, ROW};
use crate::mesh::hierarchy::LANES;
use crate::simd::SimdLevel;
use crate::skin::{ClusterPositions, skin_cluster, skin_vertex};

/// Numbers of a node's bounds in the cache: x, y, z and radius of every lane.
const NODE: usize = 4 * LANES;

/// Numbers of a row of slots: x, y, z.
const ROW_OF_POSITIONS: usize = 3 * ROW;

/// Marks the stamp of an entry that was filled before anybody asked for it.
const UNASKED: u64 = 1 << 63;

/// A palette, and bounds and positions under it as far as anybody asked for them.
#[derive(Debug)]
pub(super) struct Pose {
    palette: Vec<Affine>,
    table: JointTable,
    root: RootBox,
    level: SimdLevel,
    /// Of what the caches hold now; new with every palette.
    epoch: u64,
    nodes: Cache,
    clusters: Cache,
    /// Clusters asked for in this epoch; a few may count twice where threads met.
    asked: AtomicUsize,
}

impl Pose {
    /// Every matrix the identity.
    pub(super) fn at_rest(mesh: &ColliderMesh, level: SimdLevel) -> Self {
        Self::new(mesh, level, vec![Affine::IDENTITY; mesh.joint_count()])
    }

    /// The same palette, and nothing computed, for a mesh that may have been edited.
    pub(super) fn renewed(&self, mesh: &ColliderMesh) -> Self {
        Self::new(mesh, self.level, self.palette.clone())
    }

    fn new(mesh: &ColliderMesh, level: SimdLevel, palette: Vec<Affine>) -> Self {
        let (nodes, clusters) = (&mesh.hierarchy().nodes, mesh.clusters());
        let mut pose = Self {
            palette,
            table: JointTable::default(),
            root: RootBox::default(),
            level,
            epoch: 0,
            nodes: Cache::new(nodes.len(), nodes.len() * NODE),
            clusters: Cache::new(
                clusters.clusters.len(),
                clusters.vertices.len() / ROW * ROW_OF_POSITIONS,
            ),
            asked: AtomicUsize::new(0),
        };
        pose.renew(mesh);
        pose
    }

    /// Takes another palette; O(joints).
    pub(super) fn set(&mut self, mesh: &ColliderMesh, palette: impl Iterator<Item = Affine>) {
        for (old, new) in self.palette.iter_mut().zip(palette) {
            *old = new;
        }
        self.renew(mesh);
    }

    /// Outdates all that was computed.
    fn renew(&mut self, mesh: &ColliderMesh) {
        self.table.update(&self.palette);
        self.root = mesh.root_balls().bounds(&self.table);
        self.epoch += 1;
        *self.asked.get_mut() = 0;
    }

    pub(super) fn palette(&self) -> &[Affine] {
        &self.palette
    }

    /// Holds every vertex.
    pub(super) fn root(&self) -> &RootBox {
        &self.root
    }

    /// One vertex, skinned by itself.
    pub(super) fn position(&self, mesh: &ColliderMesh, vertex: usize) -> Vec3 {
        skin_vertex(mesh, &self.palette, vertex)
    }

    /// Spheres that hold the children of a node.
    pub(super) fn spheres(&self, mesh: &ColliderMesh, node: u32) -> Spheres {
        let index = node as usize;
        let stamp = self.nodes.stamp(index);
        if stamp & !UNASKED == self.epoch {
            if stamp & UNASKED != 0 {
                self.nodes.set_stamp(index, self.epoch);
            }
            return self.load_spheres(index);
        }
        let hierarchy = mesh.hierarchy();
        let node = &hierarchy.nodes[index];
        let (joints, weights) = (node.joints(hierarchy), node.weights(hierarchy));
        let found = spheres(self.level, node, joints, weights, &self.table);
        for (k, numbers) in found.rows().into_iter().enumerate() {
            self.nodes.store(index * NODE + k * LANES, numbers);
        }
        self.nodes.set_stamp(index, self.epoch);
        found
    }

    fn load_spheres(&self, node: usize) -> Spheres {
        let mut found = Spheres::ZERO;
        for (k, numbers) in found.rows_mut().into_iter().enumerate() {
            self.nodes.load(node * NODE + k * LANES, numbers);
        }
        found
    }

    /// The positions of a cluster's slots.
    pub(super) fn positions(&self, mesh: &ColliderMesh, cluster: u32, out: &mut ClusterPositions) {
        let index = cluster as usize;
        let clusters = mesh.clusters();
        let cluster = &clusters.clusters[index];
        let (count, first) = (cluster.rows() * ROW, first_number(cluster));
        let stamp = self.clusters.stamp(index);
        if stamp & !UNASKED == self.epoch {
            for (axis, numbers) in out.0.iter_mut().enumerate() {
                self.clusters
                    .load(first + axis * count, &mut numbers[..count]);
            }
            if stamp & UNASKED != 0 {
                self.clusters.set_stamp(index, self.epoch);
                self.asked.fetch_add(1, Ordering::Relaxed);
            }
            return;
        }
        skin_cluster(self.level, clusters, cluster, &self.palette, out);
        for (axis, numbers) in out.0.iter().enumerate() {
            self.clusters.store(first + axis * count, &numbers[..count]);
        }
        self.clusters.set_stamp(index, self.epoch);
        self.asked.fetch_add(1, Ordering::Relaxed);
    }

    /// How many clusters anybody asked for: about, where threads met.
    pub(super) fn clusters_asked(&self) -> usize {
        self.asked.load(Ordering::Relaxed)
    }

    /// Clusters that anybody asked for.
    pub(super) fn asked_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters.entries_with(|stamp| stamp == self.epoch)
    }

    /// Nodes whose bounds anybody asked for.
    pub(super) fn asked_nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.entries_with(|stamp| stamp == self.epoch)
    }

    /// Clusters that were skinned, asked for or not.
    pub(super) fn skinned_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters
            .entries_with(|stamp| stamp & !UNASKED == self.epoch)
    }

    /// Bytes of palette and caches.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.palette[..]) + self.nodes.memory() + self.clusters.memory()
    }
}

/// Where a cluster's positions begin in the cache.
fn first_number(cluster: &Cluster) -> usize {
    cluster.first_row as usize * ROW_OF_POSITIONS
}

#[cfg(test)]
mod tests;
