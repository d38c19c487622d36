//! First contact of a moving capsule with a convex solid that stands still, by directional conservative advancement,
//! as for the triangles of skinned surfaces (`clamber_surface::geometry`, whose solver says more).
//!
//! Along a unit direction n the gap `min n.p_i(t) - extent(n)` over the segment's ends p_i is at most the distance,
//! whatever the solid; ends on straight lines make it a minimum of lines, so that two values not below the radius
//! certify all times between them. n is taken from the nearest points; what takes more than a few steps looks ahead,
//! and lets n turn: extents are convex, so that along `n0 (1 - s) + n1 s` the extent is at most the same mean of both.

use clamber_surface::geometry::MovingCapsule;
use glam::DVec3;

use super::{Convex, Nearest};

/// Most steps. Ways without turns take three to six.
const STEPS: u32 = 256;

/// From this step on, directions are taken from ahead as well.
const SLOW: u32 = 4;

/// How far ahead at most, as a share of the way to where the gap would close.
const FARTHEST_AHEAD: f64 = 0.875;

/// What arithmetic may take off a gap, as a share of the lengths involved.
const LOST: f64 = 1.0 / (1u64 << 46) as f64;

/// A time that is never reached.
const NEVER: f64 = 2.0;

/// Where a moving capsule touches a solid first.
pub(in crate::shapes) struct ConvexTouch {
    pub(in crate::shapes) time: f64,
    /// `None` where the segment meets the core.
    pub(in crate::shapes) nearest: Option<Nearest>,
    pub(in crate::shapes) undecided: bool,
}

/// A direction, and when the gap along it is large enough: from a time until another.
struct Gaps {
    from: f64,
    until: f64,
    /// The least gap falls at the time asked for.
    falls: bool,
}

struct Advance<'a> {
    convex: &'a Convex<'a>,
    path: &'a MovingCapsule,
    /// What the gap has to keep: radius and rounding.
    floor: f64,
}

impl Convex<'_> {
    /// Up to the time `limit`. Never later than the first contact, at a distance of at most radius and `tolerance`
    /// unless it says undecided.
    pub(in crate::shapes) fn advance(
        &self,
        path: &MovingCapsule,
        tolerance: f64,
        limit: f64,
    ) -> Option<ConvexTouch> {
        let radius = path.radius + self.round;
        let ends = path.start.into_iter().chain(path.end);
        let size = ends.fold(radius, |size, end| size.max(end.abs().max_element()));
        let lost = size * LOST;
        let advance = Advance {
            convex: self,
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
            let Some(nearest) = self.nearest(path.at(time), guess) else {
                return touch(None, false);
            };
            let distance = nearest.distance;
            let gaps = advance.gaps(nearest.normal, time);
            let until = if gaps.from <= time { gaps.until } else { 0.0 };
            let stuck = until <= time;
            let approaching = gaps.falls || distance < earlier.1;
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
                let held = advance.look_ahead([begin, time], &nearest, earlier, ahead);
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

impl Advance<'_> {
    fn gaps(&self, n: DVec3, time: f64) -> Gaps {
        let extent = self.convex.extent(n) + self.floor;
        let (mut from, mut until) = (0.0_f64, NEVER);
        let (mut least, mut falls) = (f64::INFINITY, false);
        for (start, end) in self.path.start.into_iter().zip(self.path.end) {
            let (first, last) = (n.dot(start) - extent, n.dot(end) - extent);
            // Where the line passes through 0, if it does.
            let root = first / (first - last);
            if first < 0.0 {
                from = from.max(if last < 0.0 {
                    NEVER
                } else {
                    root * (1.0 + 1e-15)
                });
                until = until.min(if last < 0.0 { 0.0 } else { NEVER });
            } else if last < 0.0 {
                until = until.min(root * (1.0 - 1e-15));
            }
            let now = first + (last - first) * time;
            if now < least {
                (least, falls) = (now, last < first);
            }
        }
        Gaps { from, until, falls }
    }

    /// A time up to which there is no contact either, beyond the later of the two that the step went from and to:
    /// by a direction of shortly before the gap would close, if that went on as since the step before, or by one that
    /// turns from that of `nearest` to it.
    fn look_ahead(
        &self,
        [begin, time]: [f64; 2],
        nearest: &Nearest,
        (earlier, distance): (f64, f64),
        ahead: f64,
    ) -> Option<f64> {
        let rate = (distance - nearest.distance) / (begin - earlier);
        let closes = begin + (nearest.distance - self.floor) / rate;
        let closes = if rate > 0.0 { closes.min(1.0) } else { 1.0 };
        let probe = time + (closes - time).max(0.0) * ahead;
        let then = self.convex.nearest(self.path.at(probe), nearest.normal)?;
        let gaps = self.gaps(then.normal, probe);
        let turning = || self.holds_turning([nearest.normal, then.normal], [begin, probe]);
        let holds = gaps.from <= time || (gaps.from <= probe && turning());
        (holds && gaps.until > time).then_some(gaps.until)
    }

    /// Whether the gap is large enough all the time between two along a direction that turns linearly from the one to
    /// the other. It is quadratic for each end, and nowhere less than the least coefficient of its Bernstein basis.
    fn holds_turning(&self, [n, m]: [DVec3; 2], times: [f64; 2]) -> bool {
        let [first, last] = [n, m].map(|n| self.convex.extent(n));
        let [from, to] = times.map(|time| self.path.at(time));
        from.into_iter().zip(to).all(|(p, q)| {
            let between = (n.dot(q) + m.dot(p)) * 0.5 - (first + last) * 0.5;
            let ends = (n.dot(p) - first).min(m.dot(q) - last);
            between.min(ends) >= self.floor
        })
    }
}
