use super::super::cluster_view::ClusterView;
use super::super::narrow::Survivors;
use super::super::planes::SLACK;
use super::Sweep;
use super::boxes::MovingTriangle;
use super::narrow::{self, MovingBall};
use super::planes::MovingPlanes;
use crate::geometry::triangle::Corners8;
use crate::skin::ClusterPositions;
use crate::surface::SkinnedSurface;
use crate::surface::pose::Pose;

/// A cluster as skinned in both poses, copied out of their caches.
pub(super) struct MovingCluster<'a> {
    pub(super) view: ClusterView<'a>,
    poses: [&'a Pose; 2],
    start: ClusterPositions,
    /// Unused where both poses are one.
    end: ClusterPositions,
}

impl<'a> MovingCluster<'a> {
    /// Nothing yet: call [`MovingCluster::visit`] first. Made once a query, since it is large.
    pub(super) fn new(surface: &'a SkinnedSurface, poses: [&'a Pose; 2]) -> Self {
        Self {
            view: ClusterView::new(surface),
            poses,
            start: ClusterPositions::ZERO,
            end: ClusterPositions::ZERO,
        }
    }

    /// Goes to a cluster; false if it is dead or its part is disabled.
    pub(super) fn visit(&mut self, cluster: u32) -> bool {
        let seen = self.view.visit(cluster);
        if seen {
            let mesh = &self.view.surface.mesh;
            let [start, end] = self.poses;
            start.positions(mesh, cluster, &mut self.start);
            if !self.is_still() {
                end.positions(mesh, cluster, &mut self.end);
            }
        }
        seen
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
        let view = &self.view;
        let [start, end] = self.positions().map(|positions| view.somewhere(positions));
        let targets = [start, start + (end - start) * until];
        let bounds = (&MovingPlanes::facing(sweep, until, targets), until);
        let rows = view.cluster.rows();
        narrow::within_moving_planes(view.level(), self.positions(), rows, view.corners, bounds)
    }

    /// A time by which one of the triangles is touched; infinity where queries do not see all of them,
    /// since the vertex touched may be none of theirs.
    pub(super) fn touched_by<const N: usize>(&self, sweep: &Sweep<N>) -> f32 {
        let view = &self.view;
        if !view.is_whole() {
            return f32::INFINITY;
        }
        let ball = self.facing_ball(sweep);
        narrow::touched_by(view.level(), self.positions(), view.cluster.rows(), &ball)
    }

    /// The ball of a capsule that is nearest to the cluster at the start.
    fn facing_ball<const N: usize>(&self, sweep: &Sweep<N>) -> MovingBall {
        let axis = sweep.ends[N - 1] - sweep.ends[0];
        let start = self.view.somewhere(&self.start);
        let share = (start - sweep.ends[0]).dot(axis) / axis.length_squared();
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let turn = sweep.motions[N - 1] - sweep.motions[0];
        let lengths = [sweep.ends[0], axis, sweep.motions[0], turn];
        let size: f32 = lengths.map(|v| v.abs().element_sum()).iter().sum();
        MovingBall {
            center: (sweep.ends[0] + axis * share).to_array(),
            motion: (sweep.motions[0] + turn * share).to_array(),
            radius: sweep.radius,
            lost: if N == 1 { 0.0 } else { size * SLACK },
        }
    }

    /// Triangles, by their number in the cluster, whose own boxes over the motion meet a box.
    pub(super) fn in_box(&self, sides: [[f32; 3]; 2]) -> Survivors {
        let view = &self.view;
        let rows = view.cluster.rows();
        narrow::in_box(view.level(), self.positions(), rows, view.corners, sides)
    }

    /// A triangle with its corners at both ends.
    pub(super) fn moving(&self, triangle: usize) -> MovingTriangle {
        let corners = |positions| self.view.corners_in(positions, triangle);
        let [previous, current] = self.positions().map(corners);
        MovingTriangle {
            triangle: self.view.id(triangle),
            previous,
            current,
        }
    }

    /// The corners of up to eight triangles at both ends; lanes to spare repeat the first.
    pub(super) fn batch(&self, triangles: &[usize]) -> [Corners8; 2] {
        self.positions()
            .map(|positions| self.view.batch(positions, triangles))
    }
}
