use glam::Vec3;

use super::cluster_view::ClusterView;
use super::narrow::{self, Survivors};
use super::planes::Planes;
use crate::geometry::triangle::{Corners8, ShearedRay};
use crate::skin::ClusterPositions;
use crate::surface::SkinnedSurface;

/// A cluster as skinned this tick, copied out of the cache.
pub(super) struct PosedCluster<'a> {
    pub(super) view: ClusterView<'a>,
    positions: ClusterPositions,
}

impl<'a> PosedCluster<'a> {
    /// Nothing yet: call [`PosedCluster::visit`] first. Made once a query, since it is large.
    pub(super) fn new(surface: &'a SkinnedSurface) -> Self {
        Self {
            view: ClusterView::new(surface),
            positions: ClusterPositions::ZERO,
        }
    }

    /// Goes to a cluster; false if it is dead or its part is disabled.
    pub(super) fn visit(&mut self, cluster: u32) -> bool {
        let seen = self.view.visit(cluster);
        if seen {
            let surface = self.view.surface;
            let pose = &surface.current;
            pose.positions(&surface.mesh, cluster, &mut self.positions);
        }
        seen
    }

    /// Triangles, by their number in the cluster, that may be within `radius` of the segment from `a`
    /// to `b`.
    pub(super) fn near(&self, a: Vec3, b: Vec3, radius: f64) -> Survivors {
        let view = &self.view;
        let planes = Planes::facing(a, b, radius, self.somewhere());
        let rows = view.cluster.rows();
        narrow::within_planes(view.level(), &self.positions, rows, view.corners, &planes)
    }

    /// A point near the middle.
    pub(super) fn somewhere(&self) -> Vec3 {
        self.view.somewhere(&self.positions)
    }

    /// Triangles that a ray as far as `limit` may meet, and the sheared positions.
    pub(super) fn along_ray(
        &self,
        ray: &ShearedRay,
        limit: f32,
        sheared: &mut ClusterPositions,
    ) -> Survivors {
        let view = &self.view;
        narrow::along_ray(
            view.level(),
            &self.positions,
            view.cluster.rows(),
            view.corners,
            ray,
            limit,
            sheared,
        )
    }

    /// At least the distance from a point to the nearest vertex; infinite where queries do not see
    /// all triangles, since that vertex may be none of theirs.
    pub(super) fn nearest_vertex(&self, point: Vec3) -> f32 {
        let view = &self.view;
        if !view.is_whole() {
            return f32::INFINITY;
        }
        let rows = view.cluster.rows();
        narrow::nearest_vertex(view.level(), &self.positions, rows, point.to_array())
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.view.corners_in(&self.positions, triangle)
    }

    /// The corners of up to eight triangles; lanes to spare repeat the first.
    pub(super) fn batch(&self, triangles: &[usize]) -> Corners8 {
        self.view.batch(&self.positions, triangles)
    }
}
