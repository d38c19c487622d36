use glam::Vec3;

use super::narrow::{self, Survivors};
use super::planes::Planes;
use crate::geometry::triangle::{Corners8, EIGHT, ShearedRay};
use crate::mesh::TriangleId;
use crate::mesh::clusters::{BLOCK, Cluster, CornerBlock, MAX_SLOTS};
use crate::skin::ClusterPositions;
use crate::surface::SkinnedSurface;

/// Vertices that tell about where a cluster is.
const SAMPLES: usize = 8;

/// A cluster as skinned this tick, copied out of the cache.
pub(super) struct PosedCluster<'a> {
    pub(super) surface: &'a SkinnedSurface,
    pub(super) cluster: &'a Cluster,
    corners: &'a [CornerBlock],
    triangles: &'a [TriangleId],
    positions: ClusterPositions,
}

impl<'a> PosedCluster<'a> {
    /// Nothing yet: call [`PosedCluster::visit`] first. Made once a query, since it is large.
    pub(super) fn new(surface: &'a SkinnedSurface) -> Self {
        Self {
            surface,
            cluster: &Cluster::NONE,
            corners: &[],
            triangles: &[],
            positions: ClusterPositions::ZERO,
        }
    }

    /// Goes to a cluster; false if its part is disabled.
    pub(super) fn visit(&mut self, cluster: u32) -> bool {
        let clusters = self.surface.mesh.clusters();
        self.cluster = &clusters.clusters[cluster as usize];
        if !self.surface.part_enabled[self.cluster.part.index()] {
            return false;
        }
        self.corners = self.cluster.corners(clusters);
        self.triangles = self.cluster.triangles(clusters);
        let surface = self.surface;
        surface
            .current
            .positions(&surface.mesh, cluster, &mut self.positions);
        true
    }

    /// Triangles, by their number in the cluster, that may be within `radius` of the segment from `a`
    /// to `b`.
    pub(super) fn near(&self, a: Vec3, b: Vec3, radius: f64) -> Survivors {
        let (level, rows) = (self.surface.simd_level, self.cluster.rows());
        let planes = Planes::facing(a, b, radius, self.somewhere());
        narrow::within_planes(level, &self.positions, rows, self.corners, &planes)
    }

    /// A point near the middle: the mean of a few vertices.
    fn somewhere(&self) -> Vec3 {
        let slots = usize::from(self.cluster.slots);
        let sum = (0..SAMPLES).fold(Vec3::ZERO, |sum, k| {
            sum + position(&self.positions, k * slots / SAMPLES)
        });
        sum / SAMPLES as f32
    }

    /// Triangles that a ray as far as `limit` may meet, and the sheared positions.
    pub(super) fn along_ray(
        &self,
        ray: &ShearedRay,
        limit: f32,
        sheared: &mut ClusterPositions,
    ) -> Survivors {
        let (level, rows) = (self.surface.simd_level, self.cluster.rows());
        narrow::along_ray(
            level,
            &self.positions,
            rows,
            self.corners,
            ray,
            limit,
            sheared,
        )
    }

    /// At least the distance from a point to the nearest vertex; infinite where queries do not see
    /// all triangles, since that vertex may be none of theirs.
    pub(super) fn nearest_vertex(&self, point: Vec3) -> f32 {
        let surface = self.surface;
        if surface.hidden_triangles > 0 && !self.triangles.iter().all(|id| surface.shows(*id)) {
            return f32::INFINITY;
        }
        let (level, rows) = (self.surface.simd_level, self.cluster.rows());
        narrow::nearest_vertex(level, &self.positions, rows, point.to_array())
    }

    /// Those of the survivors that queries see, by number in the cluster.
    pub(super) fn enabled(&self, survivors: Survivors) -> impl Iterator<Item = usize> {
        let beyond = self.triangles.len();
        survivors
            .iter()
            .take_while(move |triangle| *triangle < beyond)
            .filter(|triangle| self.surface.shows(self.triangles[*triangle]))
    }

    pub(super) fn id(&self, triangle: usize) -> TriangleId {
        self.triangles[triangle]
    }

    /// The corners of a triangle.
    #[inline]
    pub(super) fn corners(&self, triangle: usize) -> [Vec3; 3] {
        let [a, b, c] = self.slots(triangle);
        [a, b, c].map(|slot| position(&self.positions, slot))
    }

    /// The corners of a triangle in other positions of the same slots.
    pub(super) fn corners_in(
        &self,
        positions: &ClusterPositions,
        triangle: usize,
    ) -> [[f32; 3]; 3] {
        self.slots(triangle)
            .map(|slot| position(positions, slot).to_array())
    }

    /// The corners of up to eight triangles; lanes to spare repeat the first.
    pub(super) fn batch(&self, triangles: &[usize]) -> Corners8 {
        let mut batch = Corners8::default();
        for lane in 0..EIGHT {
            let triangle = triangles.get(lane).or(triangles.first());
            if let Some(triangle) = triangle {
                batch.set(lane, self.corners(*triangle));
            }
        }
        batch
    }

    #[inline]
    fn slots(&self, triangle: usize) -> [usize; 3] {
        let CornerBlock([a, b, c]) = &self.corners[triangle / BLOCK];
        let slot = |corners: &[u8; BLOCK]| usize::from(corners[triangle % BLOCK]) % MAX_SLOTS;
        [slot(a), slot(b), slot(c)]
    }
}

#[inline]
fn position(positions: &ClusterPositions, slot: usize) -> Vec3 {
    Vec3::new(
        positions.0[0][slot],
        positions.0[1][slot],
        positions.0[2][slot],
    )
}
