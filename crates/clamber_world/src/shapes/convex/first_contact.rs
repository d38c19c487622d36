//! First contact of a moving capsule with a convex solid, which may also move, by directional conservative advancement.
//! The triangles of skinned surfaces use the same method; their solver, in `clamber_surface::geometry`, documents it in
//! more detail.
//!
//! For a direction n, |n| <= 1, the gap `min n.p_i(t) - extent(t)` over the segment's ends p_i is at most the distance,
//! for any solid. The ends and the points of the solid move in straight lines. So the extent, a maximum of linear
//! functions, is convex, and the gap is concave: between two times it is never below the line between its values there.
//! If the gap is at least the radius at both times, there is no contact between them, however poor n is. n is taken
//! from the nearest points. After a few steps the solver also looks ahead in time and lets n turn.

use clamber_surface::geometry::MovingCapsule;
use glam::DVec3;

use super::{ClosestPoints, MovingConvex};

/// Most steps. In the tests, half of the casts take at most two steps and 99 of 100 at most six. Long swinging levers
/// take at most 21.
const STEPS: u32 = 256;

/// From this step on, the solver also tries directions from ahead in time.
const SLOW: u32 = 4;

/// Farthest look ahead, as a fraction of the time until the gap would close.
const FARTHEST_AHEAD: f64 = 0.875;

/// Largest rounding error of a gap, as a fraction of the lengths involved.
const LOST: f64 = 1.0 / (1u64 << 46) as f64;

/// For solids that turn: how often the interval is shortened in search of a line that reaches farther.
const HALVINGS: u32 = 5;

/// Stands for a time after the end of the tick.
const NEVER: f64 = 2.0;

/// The first contact of a moving capsule with a solid.
pub(in crate::shapes) struct ConvexTouch {
    pub(in crate::shapes) time: f64,
    /// `None` if the segment meets the core.
    pub(in crate::shapes) nearest: Option<ClosestPoints>,
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "tests show that it does not happen")
    )]
    pub(in crate::shapes) undecided: bool,
}

struct Gap<'a> {
    solid: &'a MovingConvex<'a>,
    path: &'a MovingCapsule,
    /// The least gap without contact: radius plus rounding.
    floor: f64,
}

impl MovingConvex<'_> {
    /// The first contact up to the time `limit`. The time is never later than the true one. The distance is at most the
    /// radius plus `tolerance`, unless the contact is undecided.
    pub(in crate::shapes) fn first_contact(
        &self,
        path: &MovingCapsule,
        tolerance: f64,
        limit: f64,
    ) -> Option<ConvexTouch> {
        let radius = path.radius + self.convex.round;
        let ends = path.start.into_iter().chain(path.end);
        let size = ends.fold(radius, |size, end| size.max(end.abs().max_element()));
        let lost = size * LOST;
        let gap = Gap {
            solid: self,
            path,
            floor: radius + lost,
        };
        let near = radius + tolerance.max(4.0 * lost);
        let (mut time, mut guess) = (0.0, DVec3::ZERO);
        let (mut earlier, mut ahead) = ((0.0, 0.0), FARTHEST_AHEAD);
        for step in 1..=STEPS {
            let touch = |nearest, undecided| {
                Some(ConvexTouch {
                    time,
                    nearest,
                    undecided,
                })
            };
            let Some(nearest) = self.nearest(time, path.at(time), guess) else {
                return touch(None, false);
            };
            let distance = nearest.distance;
            let until = gap.until(nearest.normal, time).unwrap_or(0.0);
            let stuck = until <= time;
            let approaching = distance < earlier.1 || gap.falls(nearest.normal, time);
            if until > 1.0 && distance > radius {
                return None;
            }
            if distance <= radius || (distance <= near && (approaching || stuck)) {
                return touch(Some(nearest), false);
            }
            if stuck || step == STEPS {
                return touch(Some(nearest), true);
            }
            if until > limit {
                return None;
            }
            let begin = time;
            (time, guess) = (until, nearest.normal);
            if step >= SLOW {
                let held = gap.look_ahead([begin, time], &nearest, earlier, ahead);
                ahead = match held {
                    Some(_) => (ahead * 2.0).min(FARTHEST_AHEAD),
                    None => ahead * 0.5,
                };
                time = held.unwrap_or(time);
                if time > limit.min(1.0) {
                    return None;
                }
            }
            earlier = (begin, distance);
        }
        None
    }
}

impl Gap<'_> {
    /// The gap along a direction at a time, less the floor.
    fn left(&self, n: DVec3, time: f64) -> f64 {
        let ends = self.path.at(time).map(|end| n.dot(end));
        let farthest = self.solid.point(time, self.solid.support(time, n));
        ends[0].min(ends[1]) - n.dot(farthest) - self.floor
    }

    /// The time until which the gap along a direction stays above the floor, from `time` on. [`NEVER`] if it does so to
    /// the end, `None` if it is below the floor at `time`.
    fn until(&self, n: DVec3, time: f64) -> Option<f64> {
        let first = self.left(n, time);
        if first < 0.0 {
            return None;
        }
        let (mut best, mut horizon) = (time, 1.0);
        for _ in 0..=HALVINGS {
            let last = self.left(n, horizon);
            if last >= 0.0 {
                return Some(if horizon == 1.0 { NEVER } else { horizon });
            }
            let share = first / (first - last) * (1.0 - 1e-15);
            let root = time * (1.0 - share) + horizon * share;
            best = f64::max(best, root);
            // If the solid turns, the line to `horizon` falls faster than the gap does at `time`.
            let nearer = time + 2.0 * (best - time);
            if self.solid.before.is_none() || nearer >= horizon {
                break;
            }
            horizon = nearer;
        }
        Some(best)
    }

    /// True if the gap along a direction falls at a time.
    fn falls(&self, n: DVec3, time: f64) -> bool {
        let at = self.path.at(time).map(|end| n.dot(end));
        let end = usize::from(at[1] < at[0]);
        let support = self.solid.support(time, n);
        let slide = self.path.end[end] - self.path.start[end];
        let turn = self.solid.point(1.0, support) - self.solid.point(0.0, support);
        n.dot(slide - turn) < 0.0
    }

    /// A time after `time` up to which there is no contact either, if one is found. The step went from `begin` to
    /// `time`. Tries the direction of the nearest points shortly before the gap would close at its latest rate, and
    /// then a direction that turns from the one of `nearest` to that one.
    fn look_ahead(
        &self,
        [begin, time]: [f64; 2],
        nearest: &ClosestPoints,
        (earlier, distance): (f64, f64),
        ahead: f64,
    ) -> Option<f64> {
        let rate = (distance - nearest.distance) / (begin - earlier);
        let closes = begin + (nearest.distance - self.floor) / rate;
        let closes = if rate > 0.0 { closes.min(1.0) } else { 1.0 };
        let probe = time + (closes - time).max(0.0) * ahead;
        let ends = self.path.at(probe);
        let then = self.solid.nearest(probe, ends, nearest.normal)?;
        let held = self.until(then.normal, time).or_else(|| {
            let turning = self.holds_turning([nearest.normal, then.normal], [begin, probe]);
            turning.then(|| self.until(then.normal, probe)).flatten()
        });
        held.filter(|held| *held > time)
    }

    /// True if the gap stays above the floor between two times along a direction that turns linearly from `n` to `m`.
    /// For each end and point the gap is quadratic, and never less than its least Bernstein coefficient. For the points
    /// of the solid, the largest value of each coefficient stands for all.
    fn holds_turning(&self, [n, m]: [DVec3; 2], times: [f64; 2]) -> bool {
        let along = |direction: DVec3, time: f64| {
            let point = self.solid.support(time, direction);
            self.solid.point(time, point).dot(direction)
        };
        let [first, last] = times;
        // The largest `n.point(last) + m.point(first)` over the points of the solid.
        let (a, b) = (self.solid.at_rest(last, n), self.solid.at_rest(first, m));
        let point = self.solid.convex.support(a + b);
        let middle = n.dot(self.solid.point(last, point)) + m.dot(self.solid.point(first, point));
        let extents = [along(n, first), middle * 0.5, along(m, last)];
        let [from, to] = times.map(|time| self.path.at(time));
        from.into_iter().zip(to).all(|(p, q)| {
            let gaps = [n.dot(p), (n.dot(q) + m.dot(p)) * 0.5, m.dot(q)];
            gaps.into_iter()
                .zip(extents)
                .all(|(gap, extent)| gap - extent >= self.floor)
        })
    }
}
