use glam::Vec3;

use super::narrow::Survivors;
use crate::geometry::triangle::{Corners8, EIGHT};
use crate::mesh::TriangleId;
use crate::mesh::clusters::{BLOCK, Cluster, CornerBlock, MAX_SLOTS};
use crate::simd::SimdLevel;
use crate::skin::ClusterPositions;
use crate::surface::SkinnedSurface;

/// Vertices that tell about where a cluster is.
const SAMPLES: usize = 8;

/// What a cluster is made of, whatever its pose.
pub(super) struct ClusterView<'a> {
    pub(super) surface: &'a SkinnedSurface,
    pub(super) cluster: &'a Cluster,
    pub(super) corners: &'a [CornerBlock],
    triangles: &'a [TriangleId],
}

impl<'a> ClusterView<'a> {
    /// Nothing yet: call [`ClusterView::visit`] first.
    pub(super) fn new(surface: &'a SkinnedSurface) -> Self {
        Self {
            surface,
            cluster: &Cluster::NONE,
            corners: &[],
            triangles: &[],
        }
    }

    /// Goes to a cluster; false if it is dead or its part is disabled.
    pub(super) fn visit(&mut self, cluster: u32) -> bool {
        let clusters = self.surface.mesh.clusters();
        self.cluster = &clusters.clusters[cluster as usize];
        if self.cluster.is_dead() || !self.surface.part_enabled[self.cluster.part.index()] {
            return false;
        }
        self.corners = self.cluster.corners(clusters);
        self.triangles = self.cluster.triangles(clusters);
        true
    }

    pub(super) fn level(&self) -> SimdLevel {
        self.surface.simd_level
    }

    /// True if queries see all triangles.
    pub(super) fn is_whole(&self) -> bool {
        let surface = self.surface;
        surface.hidden_triangles == 0 || self.triangles.iter().all(|id| surface.shows(*id))
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

    /// The corners of a triangle in some positions of the slots.
    #[inline]
    pub(super) fn corners_in(&self, positions: &ClusterPositions, triangle: usize) -> [Vec3; 3] {
        let CornerBlock([a, b, c]) = &self.corners[triangle / BLOCK];
        let slot = |corners: &[u8; BLOCK]| usize::from(corners[triangle % BLOCK]) % MAX_SLOTS;
        [slot(a), slot(b), slot(c)].map(|slot| position(positions, slot))
    }

    /// The corners of up to eight triangles; lanes to spare repeat the first.
    pub(super) fn batch(&self, positions: &ClusterPositions, triangles: &[usize]) -> Corners8 {
        let mut batch = Corners8::default();
        for lane in 0..EIGHT {
            let triangle = triangles.get(lane).or(triangles.first());
            if let Some(triangle) = triangle {
                batch.set(lane, self.corners_in(positions, *triangle));
            }
        }
        batch
    }

    /// A point near the middle: the mean of a few vertices.
    pub(super) fn somewhere(&self, positions: &ClusterPositions) -> Vec3 {
        let slots = usize::from(self.cluster.slots);
        let sum = (0..SAMPLES).fold(Vec3::ZERO, |sum, k| {
            sum + position(positions, k * slots / SAMPLES)
        });
        sum / SAMPLES as f32
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

/// Calls `test` with up to eight of the items at a time, in their order.
pub(super) fn by_eight(mut items: impl Iterator<Item = usize>, mut test: impl FnMut(&[usize])) {
    let mut batch = [0; EIGHT];
    loop {
        let mut count = 0;
        for (place, item) in batch.iter_mut().zip(&mut items) {
            *place = item;
            count += 1;
        }
        if count == 0 {
            return;
        }
        test(&batch[..count]);
    }
}
