use glam::{DVec3, Vec3};

use crate::geometry::widen;

/// A sphere (N = 1) or a capsule (N = 2) that moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingCore<const N: usize> {
    /// The sphere's centre or one end of the capsule's segment at time 0, to which all else is
    /// relative.
    pub(crate) origin: Vec3,
    pub(crate) start: [DVec3; N],
    pub(crate) end: [DVec3; N],
    pub(crate) radius: f64,
    /// Not negative.
    pub(crate) tolerance: f64,
}

impl<const N: usize> MovingCore<N> {
    /// Of ends that each move by a vector of their own.
    pub(crate) fn new(ends: [Vec3; N], motions: [Vec3; N], radius: f32, tolerance: f32) -> Self {
        let origin = ends[0];
        let start = ends.map(|end| widen(end) - widen(origin));
        let mut end = start;
        for (end, motion) in end.iter_mut().zip(motions) {
            *end += widen(motion);
        }
        Self {
            origin,
            start,
            end,
            radius: f64::from(radius),
            tolerance: f64::from(tolerance),
        }
    }

    /// Where the ends are at a time, relative to the origin.
    fn at(&self, time: f64) -> [DVec3; N] {
        let mut ends = self.start;
        for (end, last) in ends.iter_mut().zip(self.end) {
            *end += (last - *end) * time;
        }
        ends
    }

    /// The point of the core nearest to `point` at a time; neither is relative to the origin.
    pub(crate) fn nearest(&self, time: f64, point: DVec3) -> DVec3 {
        let ends = self.at(time);
        let (origin, axis) = (widen(self.origin), ends[N - 1] - ends[0]);
        let along = (point - origin - ends[0]).dot(axis);
        let share = if along > 0.0 {
            (along / axis.length_squared()).min(1.0)
        } else {
            0.0
        };
        origin + ends[0] + axis * share
    }
}
