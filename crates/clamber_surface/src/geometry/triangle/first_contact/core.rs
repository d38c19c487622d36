use glam::{DVec3, Vec3};

use crate::geometry::widen;

/// The core and radius of a moving sphere (N = 1) or capsule (N = 2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct MovingCore<const N: usize> {
    /// The sphere's centre, or the first end of the capsule's segment, at time 0. All other points are relative to it.
    pub(crate) origin: Vec3,
    pub(crate) start: [DVec3; N],
    pub(crate) end: [DVec3; N],
    pub(crate) radius: f64,
    /// Not negative.
    pub(crate) tolerance: f64,
}

impl<const N: usize> MovingCore<N> {
    /// A core whose ends each move by their own vector.
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

    /// The ends at a time, relative to the origin.
    fn at(&self, time: f64) -> [DVec3; N] {
        let mut ends = self.start;
        for (end, last) in ends.iter_mut().zip(self.end) {
            *end += (last - *end) * time;
        }
        ends
    }

    /// The point of the core nearest to `point` at a time. Neither point is relative to the origin.
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
