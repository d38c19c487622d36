use std::sync::atomic::Ordering;

use super::SkinnedSurface;
use crate::mesh::TriangleId;

/// Counts of the bounds, clusters, vertices and triangles that this tick's queries touched.
///
/// The counts do not depend on how threads interleave. Bounds, clusters and vertices count once, however many queries
/// reach them; `triangles_tested` counts every test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostics {
    /// Number of bounds of nodes and clusters that were evaluated.
    pub bounds_evaluated: usize,
    /// Number of clusters that queries reached.
    pub clusters_touched: usize,
    /// Number of clusters that were skinned: those that queries reached, or all if the tick before touched at least
    /// three quarters of them.
    pub clusters_skinned: usize,
    /// Number of clusters of the mesh.
    pub clusters: usize,
    /// Number of vertices in the skinned clusters. A vertex on the border of several clusters counts in each.
    pub vertices_skinned: usize,
    /// Number of vertices in all clusters, counted in the same way.
    pub vertices: usize,
    /// Number of exact triangle tests. A triangle counts each time that a query tests it.
    pub triangles_tested: u64,
    /// Largest number of steps that the exact test of a cast took for a triangle.
    pub most_cast_steps: u32,
}

/// One cluster of a surface's triangles, and whether this tick's queries used it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ClusterState<'a> {
    /// The cluster's triangles. Removed triangles are in no cluster.
    pub triangles: &'a [TriangleId],
    /// True if a query reached it.
    pub touched: bool,
    /// True if it was skinned: because a query reached it, or ahead of queries, as in
    /// [`Diagnostics::clusters_skinned`].
    pub skinned: bool,
}

impl SkinnedSurface {
    /// Counts what queries touched since the last [`SkinnedSurface::advance`] or [`SkinnedSurface::teleport`]. Clusters
    /// that an edit has replaced since then no longer count. Takes O(clusters).
    pub fn diagnostics(&self) -> Diagnostics {
        let (pose, mesh) = (&self.instance.current, self.mesh());
        let [clusters_skinned, vertices_skinned] = pose.skinned_count(mesh);
        let slots = mesh.clusters().clusters.iter();
        Diagnostics {
            bounds_evaluated: pose.asked_bounds(mesh),
            clusters_touched: pose.asked_cluster_count(),
            clusters_skinned,
            clusters: mesh.clusters().living(),
            vertices_skinned,
            vertices: slots.map(|cluster| usize::from(cluster.slots)).sum(),
            triangles_tested: self.instance.triangles_tested.load(Ordering::Relaxed),
            most_cast_steps: self.instance.most_cast_steps.load(Ordering::Relaxed),
        }
    }

    /// All clusters that have triangles, and whether queries used them since the last [`SkinnedSurface::advance`] or
    /// [`SkinnedSurface::teleport`]. Takes O(clusters).
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

    /// The triangles of the clusters that queries reached since the last [`SkinnedSurface::advance`] or
    /// [`SkinnedSurface::teleport`], cluster by cluster. Takes O(clusters).
    pub fn touched_triangles(&self) -> impl Iterator<Item = TriangleId> {
        let touched = self.clusters().filter(|cluster| cluster.touched);
        touched.flat_map(|cluster| cluster.triangles.iter().copied())
    }

    /// Memory of the collider in bytes: the rest data, which surfaces share, and this surface's caches. These grow with
    /// the most clusters that a tick touches.
    pub fn memory(&self) -> usize {
        self.mesh().memory()
            + self.instance.current.memory()
            + self.instance.previous.memory()
            + self.instance.part_enabled.len()
            + self.instance.triangle_hidden.len()
    }
}

#[cfg(test)]
mod tests;
