use glam::Vec3;

use super::super::narrow::Survivors;
use super::Sweep;
use super::narrow::{self, MovingBall};
use super::planes::MovingPlanes;
use crate::geometry::triangle::{Corners8, EIGHT};
use crate::mesh::TriangleId;
use crate::mesh::clusters::{BLOCK, Cluster, CornerBlock, MAX_SLOTS};
use crate::simd::SimdLevel;
use crate::skin::ClusterPositions;
use crate::surface::SkinnedSurface;
use crate::surface::pose::Pose;

/// Vertices that tell about where a cluster is.
const SAMPLES: usize = 8;

/// A cluster as skinned in both poses, copied out of their caches.
pub(super) struct MovingCluster<'a> {
    surface: &'a SkinnedSurface,
    poses: [&'a Pose; 2],
    cluster: &'a Cluster,
    corners: &'a [CornerBlock],
    triangles: &'a [TriangleId],
    start: ClusterPositions,
    /// Unused where both poses are one.
    end: ClusterPositions,
}

impl<'a> MovingCluster<'a> {
    /// Nothing yet: call [`MovingCluster::visit`] first. Made once a query, since it is large.
    pub(super) fn new(surface: &'a SkinnedSurface, poses: [&'a Pose; 2]) -> Self {
        Self {
            surface,
            poses,
            cluster: &Cluster::NONE,
            corners: &[],
            triangles: &[],
            start: ClusterPositions::ZERO,
            end: ClusterPositions::ZERO,
        }
    }

    /// Goes to a cluster; false if its part is disabled.
    pub(super) fn visit(&mut self, cluster: u32) -> bool {
        let mesh = &self.surface.mesh;
        let clusters = mesh.clusters();
        self.cluster = &clusters.clusters[cluster as usize];
        if !self.surface.part_enabled[self.cluster.part.index()] {
            return false;
        }
        self.corners = self.cluster.corners(clusters);
        self.triangles = self.cluster.triangles(clusters);
        let [start, end] = self.poses;
        start.positions(mesh, cluster, &mut self.start);
        if !self.is_still() {
            end.positions(mesh, cluster, &mut self.end);
        }
        true
    }

    pub(super) fn level(&self) -> SimdLevel {
        self.surface.simd_level
    }

    fn is_still(&self) -> bool {
        std::ptr::eq(self.poses[0], self.poses[1])
    }

    fn positions(&self) -> [&ClusterPositions; 2] {
        let end = if self.is_still() {
            &self.start
        } else {
            &self.end
        };
        [&self.start, end]
    }

    /// Triangles, by their number in the cluster, that may be touched up to the time `until`.
    pub(super) fn along<const N: usize>(&self, sweep: &Sweep<N>, until: f32) -> Survivors {
        let (level, rows) = (self.surface.simd_level, self.cluster.rows());
        let [start, end] = self.somewhere();
        let targets = [start, start + (end - start) * until];
        let planes = MovingPlanes::facing(sweep, until, targets);
        let bounds = (&planes, until);
        narrow::within_moving_planes(level, self.positions(), rows, self.corners, bounds)
    }

    /// A time by which one of the triangles is touched; infinity where queries do not see all of them,
    /// since the vertex touched may be none of theirs.
    pub(super) fn touched_by<const N: usize>(&self, sweep: &Sweep<N>) -> f32 {
        let surface = self.surface;
        if surface.hidden_triangles > 0 && !self.triangles.iter().all(|id| surface.shows(*id)) {
            return f32::INFINITY;
        }
        let (level, rows) = (surface.simd_level, self.cluster.rows());
        let ball = self.facing_ball(sweep);
        narrow::touched_by(level, self.positions(), rows, &ball)
    }

    /// The ball of a capsule that is nearest to the cluster at the start.
    fn facing_ball<const N: usize>(&self, sweep: &Sweep<N>) -> MovingBall {
        let axis = sweep.ends[N - 1] - sweep.ends[0];
        let [start, _] = self.somewhere();
        let share = (start - sweep.ends[0]).dot(axis) / axis.length_squared();
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let turn = sweep.motions[N - 1] - sweep.motions[0];
        MovingBall {
            center: (sweep.ends[0] + axis * share).to_array(),
            motion: (sweep.motions[0] + turn * share).to_array(),
            radius: sweep.radius,
        }
    }

    /// A point near the middle in both poses: the mean of a few vertices.
    fn somewhere(&self) -> [Vec3; 2] {
        let slots = usize::from(self.cluster.slots);
        self.positions().map(|positions| {
            let sum = (0..SAMPLES).fold(Vec3::ZERO, |sum, k| {
                sum + position(positions, k * slots / SAMPLES)
            });
            sum / SAMPLES as f32
        })
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

    /// The corners of up to eight triangles at both ends; lanes to spare repeat the first.
    pub(super) fn batch(&self, triangles: &[usize]) -> [Corners8; 2] {
        self.positions().map(|positions| {
            let mut batch = Corners8::default();
            for lane in 0..EIGHT {
                let triangle = triangles.get(lane).or(triangles.first());
                if let Some(triangle) = triangle {
                    let slots = self.slots(*triangle);
                    batch.set(lane, slots.map(|slot| position(positions, slot)));
                }
            }
            batch
        })
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
