use glam::Vec3;

use super::broad::SLACK;
use super::instance::Instance;
use super::narrow::{self, MovingBall, Survivors};
use super::planes::Planes;
use super::probe::Probe;
use super::span::Span;
use crate::geometry::triangle::{Corners8, EIGHT, ShearedRay};
use crate::mesh::clusters::{BLOCK, Cluster, CornerBlock, MAX_SLOTS};
use crate::mesh::{PartId, TriangleId};
use crate::pose::PosedMesh;
use crate::simd::SimdLevel;
use crate::skin::ClusterPositions;

/// Number of vertices whose mean tells where a cluster is.
const SAMPLES: usize = 8;

/// A cluster as skinned in one pose (P = 1), or in the two poses that it moves between (P = 2), with its positions
/// copied from their caches.
pub(super) struct PosedCluster<'a, const P: usize> {
    instance: &'a Instance,
    poses: [&'a PosedMesh; P],
    cluster: &'a Cluster,
    corners: &'a [CornerBlock],
    triangles: &'a [TriangleId],
    positions: [ClusterPositions; P],
    /// The part of the motion between two poses.
    span: Span,
}

impl<'a, const P: usize> PosedCluster<'a, P> {
    /// Holds no cluster yet: call [`PosedCluster::visit`] first. Made once per query, since it is large.
    pub(super) fn new(instance: &'a Instance, poses: [&'a PosedMesh; P]) -> Self {
        Self::during(instance, poses, Span::WHOLE)
    }

    /// The same for a part of the motion between two poses: the cluster moves from where it is at the start of the span to
    /// where it is at its end.
    pub(super) fn during(instance: &'a Instance, poses: [&'a PosedMesh; P], span: Span) -> Self {
        Self {
            span,
            instance,
            poses,
            cluster: &Cluster::NONE,
            corners: &[],
            triangles: &[],
            positions: [ClusterPositions::ZERO; P],
        }
    }

    /// Loads a cluster; false if it is dead or its part is disabled.
    pub(super) fn visit(&mut self, index: u32) -> bool {
        let (instance, mesh) = (self.instance, &self.instance.mesh);
        let clusters = mesh.clusters();
        self.cluster = &clusters.clusters[index as usize];
        if self.cluster.is_dead() || !instance.part_enabled[self.cluster.part.index()] {
            return false;
        }
        self.corners = self.cluster.corners(clusters);
        self.triangles = self.cluster.triangles(clusters);
        for (pose, positions) in self.poses.iter().zip(&mut self.positions) {
            pose.positions(mesh, index, positions);
        }
        if let ([first, .., last], false) = (&mut self.positions[..], self.span.is_whole()) {
            self.span.positions([first, last], self.cluster.rows());
        }
        true
    }

    pub(super) fn level(&self) -> SimdLevel {
        self.instance.simd_level
    }

    pub(super) fn part(&self) -> PartId {
        self.cluster.part
    }

    pub(super) fn id(&self, triangle: usize) -> TriangleId {
        self.triangles[triangle]
    }

    /// Triangles that a probe may touch up to the time `until`, by their number in the cluster.
    pub(super) fn near<const N: usize>(&self, probe: &Probe<N>, until: f32) -> Survivors {
        let mut targets = self.somewhere();
        targets[P - 1] = targets[0] + (targets[P - 1] - targets[0]) * until;
        let planes = Planes::facing(probe, until, targets);
        let (positions, rows) = (self.positions.each_ref(), self.cluster.rows());
        narrow::within_planes(self.level(), positions, rows, self.corners, &planes, until)
    }

    /// Triangles whose bounding boxes over the motion overlap a box.
    pub(super) fn in_box(&self, sides: [[f32; 3]; 2]) -> Survivors {
        let (positions, rows) = (self.positions.each_ref(), self.cluster.rows());
        narrow::in_box(self.level(), positions, rows, self.corners, sides)
    }

    /// A time by which one of the triangles is touched. Infinite if some triangles are hidden, since the vertex that is
    /// touched may belong to those alone.
    pub(super) fn touched_by<const N: usize>(&self, probe: &Probe<N>) -> f32 {
        if !self.is_whole() {
            return f32::INFINITY;
        }
        let ball = self.facing_ball(probe);
        let (positions, rows) = (self.positions.each_ref(), self.cluster.rows());
        narrow::touched_by(self.level(), positions, rows, &ball)
    }

    /// The ball on the capsule's segment that is about nearest to the cluster at the start.
    fn facing_ball<const N: usize>(&self, probe: &Probe<N>) -> MovingBall {
        let [a, b] = probe.segment();
        let axis = b - a;
        let share = (self.somewhere()[0] - a).dot(axis) / axis.length_squared();
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let motion = probe.motions[0];
        let turn = probe.motions[N - 1] - motion;
        let lengths = [a, axis, motion, turn];
        let size: f32 = lengths.map(|v| v.abs().element_sum()).iter().sum();
        MovingBall {
            center: (a + axis * share).to_array(),
            motion: (motion + turn * share).to_array(),
            radius: probe.radius,
            lost: if N == 1 { 0.0 } else { size * SLACK },
        }
    }

    /// The survivors that are enabled, by number in the cluster.
    pub(super) fn enabled(&self, survivors: Survivors) -> impl Iterator<Item = usize> {
        let beyond = self.triangles.len();
        survivors
            .iter()
            .take_while(move |triangle| *triangle < beyond)
            .filter(|triangle| self.instance.shows(self.triangles[*triangle]))
    }

    /// True if all triangles of the cluster are enabled.
    fn is_whole(&self) -> bool {
        let instance = self.instance;
        instance.hidden_triangles == 0 || self.triangles.iter().all(|id| instance.shows(*id))
    }

    /// A point near the cluster's middle in each pose: the mean of a few vertices.
    pub(super) fn somewhere(&self) -> [Vec3; P] {
        let slots = usize::from(self.cluster.slots);
        let mut means = [Vec3::ZERO; P];
        for (mean, positions) in means.iter_mut().zip(&self.positions) {
            for k in 0..SAMPLES {
                *mean += position(positions, k * slots / SAMPLES);
            }
            *mean /= SAMPLES as f32;
        }
        means
    }

    /// The corners of a triangle in each pose.
    pub(super) fn corners(&self, triangle: usize) -> [[Vec3; 3]; P] {
        let mut corners = [[Vec3::ZERO; 3]; P];
        for (corners, positions) in corners.iter_mut().zip(&self.positions) {
            *corners = self.corners_in(positions, triangle);
        }
        corners
    }

    /// The corners of a triangle, looked up in the given positions of the slots.
    #[inline]
    pub(super) fn corners_in(&self, positions: &ClusterPositions, triangle: usize) -> [Vec3; 3] {
        let CornerBlock([a, b, c]) = &self.corners[triangle / BLOCK];
        let slot = |corners: &[u8; BLOCK]| usize::from(corners[triangle % BLOCK]) % MAX_SLOTS;
        [slot(a), slot(b), slot(c)].map(|slot| position(positions, slot))
    }

    /// The corners of up to eight triangles in each pose; unused lanes repeat the first triangle.
    pub(super) fn batch(&self, triangles: &[usize]) -> [Corners8; P] {
        let mut batches = [Corners8::default(); P];
        for (batch, positions) in batches.iter_mut().zip(&self.positions) {
            for lane in 0..EIGHT {
                let triangle = triangles.get(lane).or(triangles.first());
                if let Some(triangle) = triangle {
                    batch.set(lane, self.corners_in(positions, *triangle));
                }
            }
        }
        batches
    }
}

impl PosedCluster<'_, 1> {
    /// Triangles that a ray may meet up to the distance `limit`; `sheared` receives the sheared positions.
    pub(super) fn along_ray(
        &self,
        ray: &ShearedRay,
        limit: f32,
        sheared: &mut ClusterPositions,
    ) -> Survivors {
        narrow::along_ray(
            self.level(),
            &self.positions[0],
            self.cluster.rows(),
            self.corners,
            ray,
            limit,
            sheared,
        )
    }

    /// An upper bound of the distance from a point to the nearest vertex. Infinite if some triangles are hidden, since
    /// that vertex may belong to those alone.
    pub(super) fn nearest_vertex(&self, point: Vec3) -> f32 {
        if !self.is_whole() {
            return f32::INFINITY;
        }
        let rows = self.cluster.rows();
        narrow::nearest_vertex(self.level(), &self.positions[0], rows, point.to_array())
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

/// Calls `test` with up to eight items at a time, in order.
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
