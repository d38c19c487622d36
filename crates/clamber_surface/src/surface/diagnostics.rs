use std::sync::atomic::Ordering;

use super::SkinnedSurface;
use crate::mesh::TriangleId;

/// What this tick's queries touched, the same however threads interleave. Bounds, clusters and vertices count once,
/// however many queries reach them; `triangles_tested` counts every test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostics {
    /// Bounds of nodes and clusters that were evaluated.
    pub bounds_evaluated: usize,
    /// Clusters that queries reached.
    pub clusters_touched: usize,
    /// Clusters that were skinned: the touched ones, or all after a tick that touched nearly everything.
    pub clusters_skinned: usize,
    /// Clusters of the mesh.
    pub clusters: usize,
    /// Vertices of the skinned clusters. One on the border of clusters counts in each.
    pub vertices_skinned: usize,
    /// Vertices of all clusters, counted so.
    pub vertices: usize,
    /// Triangles that no box ruled out: tested exactly, each as often as queries met it.
    pub triangles_tested: u64,
    /// Most steps that the exact test of a cast took for a triangle.
    pub most_cast_steps: u32,
}

/// One cluster of a surface's triangles, and what this tick's queries made of it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ClusterState<'a> {
    /// Its triangles. Removed ones stand in no cluster.
    pub triangles: &'a [TriangleId],
    /// Queries reached it.
    pub touched: bool,
    /// It was skinned: because a query reached it, or ahead of queries, as in [`Diagnostics::clusters_skinned`].
    pub skinned: bool,
}

impl SkinnedSurface {
    /// What was touched since the last [`SkinnedSurface::advance`] or [`SkinnedSurface::place`].
    /// Clusters that an edit has replaced since then count no more. Takes O(clusters).
    pub fn diagnostics(&self) -> Diagnostics {
        let (clusters, hierarchy) = (&self.mesh().clusters().clusters, self.mesh().hierarchy());
        let slots = |cluster: usize| usize::from(clusters[cluster].slots);
        let lanes = |node: usize| usize::from(hierarchy.nodes[node].lanes);
        Diagnostics {
            bounds_evaluated: self.instance.current.asked_nodes().map(lanes).sum(),
            clusters_touched: self.instance.current.asked_clusters().count(),
            clusters_skinned: self.instance.current.skinned_clusters().count(),
            clusters: self.mesh().clusters().living(),
            vertices_skinned: self.instance.current.skinned_clusters().map(slots).sum(),
            vertices: (0..clusters.len()).map(slots).sum(),
            triangles_tested: self.instance.triangles_tested.load(Ordering::Relaxed),
            most_cast_steps: self.instance.most_cast_steps.load(Ordering::Relaxed),
        }
    }

    /// Every cluster, and what was made of it since then. Takes O(clusters).
    pub fn clusters(&self) -> impl Iterator<Item = ClusterState<'_>> {
        let clusters = self.mesh().clusters();
        let mut touched = self.instance.current.asked_clusters().peekable();
        let mut skinned = self.instance.current.skinned_clusters().peekable();
        let all = clusters.clusters.iter().enumerate();
        let states = all.map(move |(index, cluster)| ClusterState {
            triangles: cluster.triangles(clusters),
            touched: touched.next_if_eq(&index).is_some(),
            skinned: skinned.next_if_eq(&index).is_some(),
        });
        states.filter(|cluster| !cluster.triangles.is_empty())
    }

    /// The triangles of the clusters that queries have reached since then, cluster by cluster. Takes
    /// O(clusters).
    pub fn touched_triangles(&self) -> impl Iterator<Item = TriangleId> {
        let touched = self.clusters().filter(|cluster| cluster.touched);
        touched.flat_map(|cluster| cluster.triangles.iter().copied())
    }

    /// Bytes that the collider takes: the rest data that surfaces share, and this surface's caches.
    pub fn memory(&self) -> usize {
        self.mesh().memory()
            + self.instance.current.memory()
            + self.instance.previous.memory()
            + self.instance.part_enabled.len()
            + self.instance.triangle_enabled.len()
    }
}

#[cfg(test)]
mod tests;
