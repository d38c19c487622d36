use fearless_simd::Simd;
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
use crate::skin::{ClusterPositions, SkinnedCluster};

/// A cluster as skinned in one pose (P = 1), or at the two ends of a motion (P = 2).
pub(super) struct PosedCluster<'a, const P: usize> {
    instance: &'a Instance,
    cluster: &'a Cluster,
    corners: &'a [CornerBlock],
    triangles: &'a [TriangleId],
    skinned: [&'a SkinnedCluster; P],
}

impl<'a, const P: usize> PosedCluster<'a, P> {
    /// A cluster in the given poses; `None` if it is dead or its part is disabled.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn visit(
        instance: &'a Instance,
        poses: [&'a PosedMesh; P],
        index: u32,
    ) -> Option<Self> {
        let mesh = &instance.mesh;
        let clusters = mesh.clusters();
        let cluster = &clusters.clusters[index as usize];
        let is_there = !cluster.is_dead() && instance.part_enabled[cluster.part.index()];
        is_there.then(|| Self {
            instance,
            cluster,
            corners: cluster.corners(clusters),
            triangles: cluster.triangles(clusters),
            skinned: poses.map(|pose| pose.cluster(mesh, index)),
        })
    }

    /// The same cluster over a span, a part of the motion. `ends` stores its positions at both ends of the span, if the
    /// span is not the whole motion.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn during<'b>(
        self,
        span: &Span,
        ends: &'b mut Option<[SkinnedCluster; 2]>,
    ) -> PosedCluster<'b, P>
    where
        'a: 'b,
    {
        if P == 1 || span.is_whole() {
            return self;
        }
        let [first, last] = ends.insert([self.skinned[0].clone(), self.skinned[P - 1].clone()]);
        span.positions(
            [&mut first.positions, &mut last.positions],
            self.cluster.rows(),
        );
        let mut skinned = [&*first; P];
        skinned[P - 1] = last;
        PosedCluster {
            instance: self.instance,
            cluster: self.cluster,
            corners: self.corners,
            triangles: self.triangles,
            skinned,
        }
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

    fn positions(&self) -> [&'a ClusterPositions; P] {
        self.skinned.map(|skinned| &skinned.positions)
    }

    /// False only if nothing of the cluster comes into a box, at the ends of its motion or between them.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn enters(&self, [low, high]: [[f32; 3]; 2]) -> bool {
        let (first, last) = (self.skinned[0], self.skinned[P - 1]);
        let mut beyond = false;
        for axis in 0..3 {
            beyond |= (first.low[axis] > high[axis]) & (last.low[axis] > high[axis]);
            beyond |= (first.high[axis] < low[axis]) & (last.high[axis] < low[axis]);
        }
        !beyond
    }

    /// False only if nothing of the cluster comes within a distance of a probe's core before it moves. For a capsule,
    /// that is measured from the box around its segment.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn comes_within<const N: usize>(&self, probe: &Probe<N>, distance: f32) -> bool {
        let [a, b] = probe.segment();
        let ([first, last], skinned) = ([a.min(b), a.max(b)], self.skinned[0]);
        let mut square = 0.0;
        for axis in 0..3 {
            // Differences of f32 have an error of half a unit in the last place.
            let below = skinned.low[axis] - last[axis];
            let above = first[axis] - skinned.high[axis];
            let apart = if below > above { below } else { above };
            let apart = if apart > 0.0 { apart } else { 0.0 };
            square += apart * apart;
        }
        let reach = distance * (1.0 + SLACK);
        // A square that overflows is beyond any reach whose square does not overflow. NaN does not occur.
        square <= reach * reach || square <= f32::MIN_POSITIVE
    }

    /// Triangles that a probe may touch up to the time `until`, by their number in the cluster.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn near<S: Simd, const N: usize>(
        &self,
        simd: S,
        probe: &Probe<N>,
        until: f32,
    ) -> Survivors {
        let mut targets = self.middle();
        targets[P - 1] = targets[0] + (targets[P - 1] - targets[0]) * until;
        let planes = Planes::facing(probe, until, targets);
        let rows = self.cluster.rows();
        let survivors =
            narrow::within_planes(simd, self.positions(), rows, self.corners, &planes, until);
        self.enabled(survivors)
    }

    /// The given triangles that have a corner in a probe before it moves, by more than rounding. The exact test would
    /// find them within the probe too, since its distance exceeds the distance of a corner by rounding at most.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn surely_within<S: Simd, const N: usize>(
        &self,
        simd: S,
        probe: &Probe<N>,
        survivors: Survivors,
    ) -> Survivors {
        let ball = self.facing_ball(probe);
        let positions = self.positions()[0];
        let within = narrow::within_ball(simd, positions, self.cluster.rows(), self.corners, &ball);
        survivors.and(within)
    }

    /// Triangles whose bounding boxes over the motion overlap a box.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn in_box<S: Simd>(&self, simd: S, sides: [[f32; 3]; 2]) -> Survivors {
        let rows = self.cluster.rows();
        let survivors = narrow::in_box(simd, self.positions(), rows, self.corners, sides);
        self.enabled(survivors)
    }

    /// A time by which one of the triangles is touched. Infinite if some triangles are hidden, since the vertex that is
    /// touched may belong to those alone.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn touched_by<S: Simd, const N: usize>(&self, simd: S, probe: &Probe<N>) -> f32 {
        if !self.is_whole() {
            return f32::INFINITY;
        }
        let ball = self.facing_ball(probe);
        narrow::touched_by(simd, self.positions(), self.cluster.rows(), &ball)
    }

    /// The ball on the capsule's segment that is about nearest to the cluster at the start.
    fn facing_ball<const N: usize>(&self, probe: &Probe<N>) -> MovingBall {
        let [a, b] = probe.segment();
        let axis = b - a;
        let share = (self.middle()[0] - a).dot(axis) / axis.length_squared();
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

    /// The survivors that exist and are enabled.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn enabled(&self, mut survivors: Survivors) -> Survivors {
        survivors.truncate(self.triangles.len());
        if self.instance.hidden_triangles > 0 {
            survivors.retain(|triangle| self.instance.shows(self.triangles[triangle]));
        }
        survivors
    }

    /// True if all triangles of the cluster are enabled.
    fn is_whole(&self) -> bool {
        let instance = self.instance;
        instance.hidden_triangles == 0 || self.triangles.iter().all(|id| instance.shows(*id))
    }

    /// The middle of the box around the cluster, in each pose.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn middle(&self) -> [Vec3; P] {
        let mut middles = [Vec3::ZERO; P];
        for (middle, skinned) in middles.iter_mut().zip(self.skinned) {
            *middle = Vec3::from(skinned.low) * 0.5 + Vec3::from(skinned.high) * 0.5;
        }
        middles
    }

    /// The corners of a triangle in each pose.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn corners(&self, triangle: usize) -> [[Vec3; 3]; P] {
        let mut corners = [[Vec3::ZERO; 3]; P];
        for (corners, positions) in corners.iter_mut().zip(self.positions()) {
            *corners = self.corners_in(positions, triangle);
        }
        corners
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn corners_in(&self, positions: &ClusterPositions, triangle: usize) -> [Vec3; 3] {
        let CornerBlock([a, b, c]) = &self.corners[triangle / BLOCK];
        let slot = |corners: &[u8; BLOCK]| usize::from(corners[triangle % BLOCK]) % MAX_SLOTS;
        [
            position(positions, slot(a)),
            position(positions, slot(b)),
            position(positions, slot(c)),
        ]
    }

    /// Finds the corners of up to eight triangles in each pose; unused lanes repeat the first triangle. There must be
    /// one.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn batch(&self, triangles: &[u8], batches: &mut [Corners8; P]) {
        let mut lanes = [triangles[0]; EIGHT];
        lanes[..triangles.len()].copy_from_slice(triangles);
        let mut slots = [[0u8; EIGHT]; 3];
        for (lane, triangle) in lanes.into_iter().enumerate() {
            let triangle = usize::from(triangle);
            let CornerBlock(corners) = &self.corners[triangle / BLOCK];
            for (slots, corners) in slots.iter_mut().zip(corners) {
                slots[lane] = corners[triangle % BLOCK];
            }
        }
        for (batch, positions) in batches.iter_mut().zip(self.positions()) {
            take(&positions.0[0], &slots, &mut batch.x);
            take(&positions.0[1], &slots, &mut batch.y);
            take(&positions.0[2], &slots, &mut batch.z);
        }
    }
}

/// Takes the numbers in some slots. Not inlined: it is called often, and its loop is unrolled.
#[inline(never)]
fn take(numbers: &[f32; MAX_SLOTS], slots: &[[u8; EIGHT]; 3], taken: &mut [[f32; EIGHT]; 3]) {
    let slots = slots.as_flattened();
    for (number, slot) in taken.as_flattened_mut().iter_mut().zip(slots) {
        *number = numbers[usize::from(*slot) % MAX_SLOTS];
    }
}

impl PosedCluster<'_, 1> {
    /// False only if a ray passes by the box around the cluster.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn may_meet(&self, ray: &ShearedRay, limit: f32) -> bool {
        let [skinned] = self.skinned;
        ray.may_meet_box(skinned.low, skinned.high, limit)
    }

    /// Triangles that a ray may meet up to the distance `limit`.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn along_ray<S: Simd>(&self, simd: S, ray: &ShearedRay, limit: f32) -> Survivors {
        let [positions] = self.positions();
        let rows = self.cluster.rows();
        let survivors = narrow::along_ray(simd, positions, rows, self.corners, ray, limit);
        self.enabled(survivors)
    }

    /// An upper bound of the distance from a point to the nearest vertex. Infinite if some triangles are hidden, since
    /// that vertex may belong to those alone.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn nearest_vertex<S: Simd>(&self, simd: S, point: Vec3) -> f32 {
        if !self.is_whole() {
            return f32::INFINITY;
        }
        let ([positions], rows) = (self.positions(), self.cluster.rows());
        narrow::nearest_vertex(simd, positions, rows, point.to_array())
    }
}

#[cfg_attr(not(unoptimized), inline(always))]
fn position(positions: &ClusterPositions, slot: usize) -> Vec3 {
    Vec3::new(
        positions.0[0][slot],
        positions.0[1][slot],
        positions.0[2][slot],
    )
}
