//! One pose of a surface, with caches of the values that queries have computed: bounds of nodes, skinned clusters.

mod memo;
mod whole;

use glam::Vec3;

use self::memo::Memo;
use crate::bounds::{Bounds, JointTable, RootBox, find_spheres, root_box, spheres};
use crate::geometry::{Affine, Sphere};
use crate::mesh::hierarchy::Child;
use crate::mesh::{ColliderMesh, PartId};
use crate::simd::SimdLevel;
use crate::skin::{SkinnedCluster, skin_vertex};

/// A palette, with the bounds and positions that were requested under it so far.
#[derive(Debug)]
pub(crate) struct PosedMesh {
    palette: Vec<Affine>,
    table: JointTable,
    root: RootBox,
    level: SimdLevel,
    nodes: Memo<Bounds>,
    clusters: Memo<SkinnedCluster>,
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
            nodes: Memo::new(0),
            clusters: Memo::new(0),
        };
        pose.grow(mesh);
        pose.renew(mesh);
        pose
    }

    /// Grows the caches to the mesh's node and cluster counts.
    fn grow(&mut self, mesh: &ColliderMesh) {
        self.nodes.grow(mesh.hierarchy().nodes.len());
        self.clusters.grow(mesh.clusters().clusters.len());
    }

    /// Updates the pose after an edit of the mesh in which some clusters died and others were appended. Cached values
    /// of the other clusters stay valid. O(joints, clusters edited and clusters skinned).
    pub(crate) fn follow(&mut self, mesh: &ColliderMesh, dead: &[u32]) {
        self.clusters.forget(dead);
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
        self.nodes.forget_all();
        self.clusters.forget_all();
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

    /// Bounds that hold the children of a node.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn bounds(&self, mesh: &ColliderMesh, node: u32) -> &Bounds {
        let index = node as usize;
        self.nodes.get(index, |found| {
            let (hierarchy, table) = (mesh.hierarchy(), &self.table);
            let node = &hierarchy.nodes[index];
            found.write_spheres(|found| find_spheres(self.level, hierarchy, node, table, found));
        })
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

    /// A cluster as this pose skins it.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn cluster(&self, mesh: &ColliderMesh, cluster: u32) -> &SkinnedCluster {
        let index = cluster as usize;
        self.clusters.get(index, |found| {
            let clusters = mesh.clusters();
            found.skin(
                self.level,
                clusters,
                &clusters.clusters[index],
                &self.palette,
            );
        })
    }

    /// Clusters that were requested in this pose.
    pub(crate) fn asked_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters.asked().into_iter()
    }

    /// Number of clusters that were requested in this pose.
    pub(crate) fn asked_cluster_count(&self) -> usize {
        let mut count = 0;
        self.clusters.each_asked(|_| count += 1);
        count
    }

    /// Number of children of the nodes whose bounds were requested in this pose.
    pub(crate) fn asked_bounds(&self, mesh: &ColliderMesh) -> usize {
        let (nodes, mut count) = (&mesh.hierarchy().nodes, 0);
        self.nodes
            .each_asked(|node| count += usize::from(nodes[node].lanes));
        count
    }

    /// Numbers of clusters that were skinned in this pose, requested or not, and of their vertices.
    pub(crate) fn skinned_count(&self, mesh: &ColliderMesh) -> [usize; 2] {
        let (clusters, mut counts) = (&mesh.clusters().clusters, [0; 2]);
        self.clusters.each_filled(|cluster| {
            counts[0] += 1;
            counts[1] += usize::from(clusters[cluster].slots);
        });
        counts
    }

    /// Nodes whose bounds were requested in this pose.
    #[cfg(test)]
    pub(crate) fn asked_nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.asked().into_iter()
    }

    /// Clusters that were skinned in this pose, requested or not.
    pub(crate) fn skinned_clusters(&self) -> impl Iterator<Item = usize> {
        self.clusters.filled().into_iter()
    }

    /// Size of palette and caches in bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.palette[..]) + self.nodes.memory() + self.clusters.memory()
    }
}

#[cfg(test)]
mod tests;
