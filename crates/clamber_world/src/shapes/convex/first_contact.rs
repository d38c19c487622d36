//! First contact of a moving capsule with a convex solid, which may move, too, by directional conservative advancement,
//! as for the triangles of skinned surfaces (`clamber_surface::geometry`, whose solver says more).
//!
//! Along a direction n, |n| <= 1, the gap `min n.p_i(t) - extent(t)` over the segment's ends p_i is at most the distance,
//! whatever the solid. Ends and points of the solid go on straight lines: the extent, a maximum of linear functions, is
//! convex, and the gap is concave. So a line between its values at two times is nowhere more than it, and where both are
//! not below the radius, there is no contact between, however poor n is. n is taken from the nearest points; what takes
//! more than a few steps looks ahead, and lets n turn.

use clamber_surface::geometry::MovingCapsule;
use glam::DVec3;

use super::{ClosestPoints, MovingConvex};

/// Most steps. In the tests half of the ways take two at most, 99 of 100 up to six, and long levers that swing up to 21.
const STEPS: u32 = 256;

/// From this step on, directions are taken from ahead as well.
const SLOW: u32 = 4;

/// How far ahead at most, as a share of the way to where the gap would close.
const FARTHEST_AHEAD: f64 = 0.875;

/// What arithmetic may take off a gap, as a share of the lengths involved.
const LOST: f64 = 1.0 / (1u64 << 46) as f64;

/// How often a shorter while is looked at for a better line, of what turns.
const HALVINGS: u32 = 5;

/// A time that is never reached.
const NEVER: f64 = 2.0;

/// Where a moving capsule touches a solid first.
pub(in crate::shapes) struct ConvexTouch {
    pub(in crate::shapes) time: f64,
    /// `None` where the segment meets the core.
    pub(in crate::shapes) nearest: Option<ClosestPoints>,
    pub(in crate::shapes) undecided: bool,
}

struct Gap<'a> {
    solid: &'a MovingConvex<'a>,
    path: &'a MovingCapsule,
    /// What the gap has to keep: radius and rounding.
    floor: f64,
}

impl MovingConvex<'_> {
    /// Up to the time `limit`. Never later than the first contact, at a distance of at most radius and `tolerance`
    /// unless it says undecided.
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
    /// What is left along a direction at a time, of the gap beyond the floor.
    fn left(&self, n: DVec3, time: f64) -> f64 {
        let ends = self.path.at(time).map(|end| n.dot(end));
        let farthest = self.solid.point(time, self.solid.support(time, n));
        ends[0].min(ends[1]) - n.dot(farthest) - self.floor
    }

    /// Until when the gap along a direction is large enough, from a time on; [`NEVER`] if it stays so to the end, `None`
    /// if it is not so then.
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
            // Of what turns, the line up to then falls faster than the gap now.
            let nearer = time + 2.0 * (best - time);
            if self.solid.before.is_none() || nearer >= horizon {
                break;
            }
            horizon = nearer;
        }
        Some(best)
    }

    /// Whether the gap along a direction falls at a time.
    fn falls(&self, n: DVec3, time: f64) -> bool {
        let at = self.path.at(time).map(|end| n.dot(end));
        let end = usize::from(at[1] < at[0]);
        let support = self.solid.support(time, n);
        let slide = self.path.end[end] - self.path.start[end];
        let turn = self.solid.point(1.0, support) - self.solid.point(0.0, support);
        n.dot(slide - turn) < 0.0
    }

    /// A time up to which there is no contact either, beyond the later of the two that the step went from and to:
    /// by a direction of shortly before the gap would close, if that went on as since the step before, or by one that
    /// turns from that of `nearest` to it.
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

    /// Whether the gap is large enough all the time between two along a direction that turns linearly from the one to
    /// the other. It is quadratic for each end and point, and nowhere less than the least coefficient of its Bernstein
    /// basis; of the solid's points the largest of each stands for all.
    fn holds_turning(&self, [n, m]: [DVec3; 2], times: [f64; 2]) -> bool {
        let along = |direction: DVec3, time: f64| {
            let point = self.solid.support(time, direction);
            self.solid.point(time, point).dot(direction)
        };
        let [first, last] = times;
        // Of `n.place(last) + m.place(first)` over the points of the solid.
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
