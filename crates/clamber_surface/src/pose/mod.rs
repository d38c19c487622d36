//! One pose of a surface, with caches of what queries have computed: bounds of nodes, skinned clusters.

mod cache;
mod whole;

use glam::Vec3;

use self::cache::Cache;
use crate::bounds::{JointTable, RootBox, Spheres, root_box, spheres};
use crate::geometry::{Affine, Sphere};
use crate::mesh::clusters::{Cluster, ROW};
use crate::mesh::hierarchy::{Child, LANES};
use crate::mesh::{ColliderMesh, PartId};
use crate::simd::SimdLevel;
use crate::skin::{ClusterPositions, skin_cluster, skin_vertex};

/// How many numbers a node's bounds take in the cache: x, y, z and radius of every lane.
const NODE: usize = 4 * LANES;

/// How many numbers a row of slots takes in the cache: x, y, z of every slot.
const ROW_OF_POSITIONS: usize = 3 * ROW;

/// A palette, with the bounds and positions that were requested under it so far.
#[derive(Debug)]
pub(crate) struct PosedMesh {
    palette: Vec<Affine>,
    table: JointTable,
    root: RootBox,
    level: SimdLevel,
    /// The epoch of the current palette. Every new palette gets a new one, which invalidates older cache entries.
    epoch: u64,
    nodes: Cache,
    clusters: Cache,
}

impl PosedMesh {
    /// A pose in which every matrix is the identity.
    pub(crate) fn at_rest(mesh: &ColliderMesh, level: SimdLevel) -> Self {
        Self::new(mesh, level, vec![Affine::IDENTITY; mesh.joint_count()])
    }

    /// A pose with the same palette and empty caches, for a mesh that may have been edited.
    pub(crate) fn renewed(&self, mesh: &ColliderMesh) -> Self {
        Self::new(mesh, self.level, self.palette.clone())
    }

    fn new(mesh: &ColliderMesh, level: SimdLevel, palette: Vec<Affine>) -> Self {
        let mut pose = Self {
            palette,
            table: JointTable::default(),
            root: RootBox::default(),
            level,
            epoch: 0,
            nodes: Cache::new(0, 0),
            clusters: Cache::new(0, 0),
        };
        pose.grow(mesh);
        pose.renew(mesh);
        pose
    }

    /// Grows the caches to the mesh's node and cluster counts.
    fn grow(&mut self, mesh: &ColliderMesh) {
        let (nodes, clusters) = (mesh.hierarchy().nodes.len(), mesh.clusters());
        let rows = clusters.vertices.len() / ROW;
        self.nodes.grow(nodes, nodes * NODE);
        self.clusters
            .grow(clusters.clusters.len(), rows * ROW_OF_POSITIONS);
    }

    /// Updates the pose after an edit of the mesh in which some clusters died and others were appended. What was
    /// computed of the other clusters stays valid. O(joints and clusters edited).
    pub(crate) fn follow(&mut self, mesh: &ColliderMesh, dead: &[u32]) {
        for cluster in dead {
            self.clusters.forget(*cluster as usize);
        }
        self.grow(mesh);
        self.root = root_box(mesh.joint_balls(), &self.table);
    }

    /// Replaces the palette, which invalidates the caches. O(joints).
    pub(crate) fn set(&mut self, mesh: &ColliderMesh, palette: impl Iterator<Item = Affine>) {
        for (old, new) in self.palette.iter_mut().zip(palette) {
            *old = new;
        }
        self.renew(mesh);
    }

    /// Invalidates the caches, and computes the joint table and the root box of the palette.
    fn renew(&mut self, mesh: &ColliderMesh) {
        self.table.update(&self.palette);
        self.root = root_box(mesh.joint_balls(), &self.table);
        self.epoch += 1;
    }

    pub(crate) fn palette(&self) -> &[Affine] {
        &self.palette
    }

    /// A box that holds every vertex.
    pub(crate) fn root(&self) -> &RootBox {
        &self.root
    }

    /// The position of one vertex, skinned without its cluster.
    pub(crate) fn position(&self, mesh: &ColliderMesh, vertex: usize) -> Vec3 {
        skin_vertex(mesh, &self.palette, vertex)
    }

    /// Spheres that hold the children of a node.
    pub(crate) fn spheres(&self, mesh: &ColliderMesh, node: u32) -> Spheres {
        let index = node as usize;
        let mut found = Spheres::ZERO;
        let parts = found.rows_mut().map(|row| &mut row[..]);
        if self.nodes.recall(index, self.epoch, index * NODE, parts) {
            return found;
        }
        let hierarchy = mesh.hierarchy();
        found = spheres(self.level, hierarchy, &hierarchy.nodes[index], &self.table);
        let parts = found.rows().map(|row| &row[..]);
        self.nodes.keep(index, self.epoch, index * NODE, parts);
        found
    }

    /// A bounding sphere for every part that has triangles.
    pub(crate) fn part_spheres(
        &self,
        mesh: &ColliderMesh,
    ) -> impl Iterator<Item = (PartId, Sphere)> {
        let parts = mesh.part_nodes();
        parts.nodes.iter().flat_map(|node| {
            let found = spheres(self.level, parts, node, &self.table);
            (0..usize::from(node.lanes)).map(move |lane| {
                let (Child::Cluster(part) | Child::Node(part)) = node.child(lane);
                (PartId(part), found.sphere(lane))
            })
        })
    }

    /// Writes the positions of a cluster's slots to `out`.
    pub(crate) fn positions(&self, mesh: &ColliderMesh, cluster: u32, out: &mut ClusterPositions) {
        let index = cluster as usize;
        let clusters = mesh.clusters();
        let cluster = &clusters.clusters[index];
        let (slots, first) = (cluster.rows() * ROW, first_number(cluster));
        let parts = out.0.each_mut().map(|axis| &mut axis[..slots]);
        if !self.clusters.recall(index, self.epoch, first, parts) {
            skin_cluster(self.level, clusters, cluster, &self.palette, out);
            let parts = out.0.each_ref().map(|axis| &axis[..slots]);
            self.clusters.keep(index, self.epoch, first, parts);
        }
    }

    /// Clusters that were requested in this pose.
    pub(crate) fn asked_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters.asked(self.epoch)
    }

    /// Nodes whose bounds were requested in this pose.
    pub(crate) fn asked_nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.asked(self.epoch)
    }

    /// Clusters that were skinned in this pose, requested or not.
    pub(crate) fn skinned_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters.filled(self.epoch)
    }

    /// Size of palette and caches in bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.palette[..]) + self.nodes.memory() + self.clusters.memory()
    }
}

/// Where a cluster's positions begin in the cache.
fn first_number(cluster: &Cluster) -> usize {
    cluster.first_row as usize * ROW_OF_POSITIONS
}

#[cfg(test)]
mod tests;
