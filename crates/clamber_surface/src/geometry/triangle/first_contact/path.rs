use super::gaps::{Floors, taxicab};
use super::separation::{Separation, direction};
use super::{CONTACT, FARTHEST_AHEAD, GOING, LOST, MISS, SLOW, STEPS, UNDECIDED};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// Per lane a triangle, still (P = 1) or moving (P = 2); in all lanes the same core.
pub(super) struct Path<L, const N: usize, const P: usize> {
    /// At the start and, if it moves, at the end.
    pub(super) corners: [[Vector3<L>; 3]; P],
    pub(super) core_start: [Vector3<L>; N],
    pub(super) core_end: [Vector3<L>; N],
    pub(super) radius: L,
    pub(super) tolerance: L,
}

/// What is known of each lane.
#[derive(Clone, Copy)]
pub(super) struct Found<L> {
    /// One of [`MISS`], [`CONTACT`], [`UNDECIDED`]; [`GOING`] until one is known.
    pub(super) verdict: L,
    /// No contact before.
    pub(super) time: L,
    /// Of the nearest points at that time.
    pub(super) weights: [L; 3],
    pub(super) distance: L,
}

/// What is the same at every step.
struct Terms<L, const N: usize, const P: usize> {
    /// What does not matter is later than this.
    limit: L,
    floors: Floors<L, N, P>,
    /// What arithmetic may have taken off a distance.
    lost: L,
    /// A distance that counts as a contact.
    near: L,
}

/// How the last step went, for those that look ahead.
struct Progress<L> {
    time: L,
    distance: L,
    /// The share of the way to where the gap would close at which a direction is sought next.
    ahead: L,
}

impl<L: Lanes, const N: usize, const P: usize> Path<L, N, P> {
    /// Per lane the verdict; in how many steps, those of the slowest lane.
    #[inline(always)]
    pub(super) fn first_contact(&self, limit: L) -> (Found<L>, u32) {
        let zero = limit.splat(0.0);
        let terms = self.terms(limit);
        let mut found = Found {
            verdict: zero.splat(GOING),
            time: zero,
            weights: [zero; 3],
            distance: zero,
        };
        let mut progress = Progress {
            time: zero,
            distance: zero,
            ahead: zero.splat(FARTHEST_AHEAD),
        };
        let mut steps = 0;
        loop {
            steps += 1;
            let (time, is_going) = (found.time, found.is_going());
            let nearest = self.separation(time);
            let distance = terms.measured(&nearest);
            found.distance = L::select(is_going, distance, found.distance);
            for (kept, weight) in found.weights.iter_mut().zip(nearest.weights) {
                *kept = L::select(is_going, weight, *kept);
            }
            let (until, approaching) = self.certified(&nearest, distance, &found, &terms);
            // What turns or slides closer does so although no line falls along n of the moment.
            let approaching = approaching | distance.less(progress.distance);
            let last = steps == STEPS;
            let verdict = self.verdict([time, until, distance], approaching, &terms, last);
            found.verdict = L::select(is_going, verdict, found.verdict);
            found.time = L::select(found.is_going(), until, time);
            if steps >= SLOW && L::any(found.is_going()) {
                let now = [time, distance];
                self.look_ahead(now, &nearest, &mut found, &mut progress, &terms);
            }
            if !L::any(found.is_going()) {
                return (found, steps);
            }
            (progress.time, progress.distance) = (time, distance);
        }
    }

    #[inline(always)]
    fn terms(&self, limit: L) -> Terms<L, N, P> {
        let lost = self.size() * limit.splat(LOST);
        let least_tolerance = lost * limit.splat(4.0);
        Terms {
            limit,
            floors: self.floors(),
            lost,
            near: self.radius + (self.tolerance - lost).or_larger(least_tolerance),
        }
    }

    /// Until when the gap is large enough, not later than now if it is not so now; and whether it falls
    /// now.
    #[inline(always)]
    fn certified(
        &self,
        nearest: &Separation<L>,
        distance: L,
        found: &Found<L>,
        terms: &Terms<L, N, P>,
    ) -> (L, L::Mask) {
        let (time, zero) = (found.time, distance.splat(0.0));
        let n = direction(nearest.apart, distance);
        let gaps = self.gaps(n, &terms.floors, time);
        let mut until = L::select(gaps.from.at_most(time), gaps.until, zero);
        let stuck = until.at_most(time);
        if L::any(found.is_going() & stuck) {
            let upright = nearest.upright();
            let n = direction(upright, upright.length());
            let gaps = self.gaps(n, &terms.floors, time);
            let better = stuck & gaps.from.at_most(time);
            until = L::select(better, gaps.until, until);
        }
        (until, gaps.approaching)
    }

    #[inline(always)]
    fn verdict(
        &self,
        [time, until, distance]: [L; 3],
        approaching: L::Mask,
        terms: &Terms<L, N, P>,
        last: bool,
    ) -> L {
        let one = time.splat(1.0);
        let (going, miss) = (time.splat(GOING), time.splat(MISS));
        let (contact, undecided) = (time.splat(CONTACT), time.splat(UNDECIDED));
        let stuck = until.at_most(time);
        let is_near = distance.at_most(terms.near);
        let touches = (is_near & (approaching | stuck)) | distance.at_most(self.radius);
        let misses = one.less(until) & self.radius.less(distance);
        // Pruning comes first, to be overruled, so that it changes no contact that is found.
        let verdict = L::select(terms.limit.less(until), miss, going);
        let verdict = L::select(stuck, undecided, verdict);
        let verdict = if last { undecided } else { verdict };
        let verdict = L::select(touches, contact, verdict);
        L::select(misses, miss, verdict)
    }

    /// Goes on from `found.time` by a direction of shortly before the gap would close, if that went on
    /// as since the last step, or by one that turns from that of `nearest`, where this step began, to it.
    #[inline(always)]
    fn look_ahead(
        &self,
        [begin, distance]: [L; 2],
        nearest: &Separation<L>,
        found: &mut Found<L>,
        progress: &mut Progress<L>,
        terms: &Terms<L, N, P>,
    ) {
        let time = found.time;
        let (zero, one) = (time.splat(0.0), time.splat(1.0));
        let rate = (progress.distance - distance) / (begin - progress.time);
        let closes = begin + (distance - self.radius) / rate;
        let closes = L::select(zero.less(rate) & closes.less(one), closes, one);
        let probe = time + (closes - time) * progress.ahead;
        let probe = L::select(time.less(probe), probe, time);
        let now = direction(nearest.apart, distance);
        let apart = self.separation(probe).apart;
        let then = direction(apart, apart.length());
        let gaps = self.gaps(then, &terms.floors, probe);
        let turning = self.holds_turning([now, then], [begin, probe], &terms.floors);
        let until_then = gaps.from.at_most(time) | (turning & gaps.from.at_most(probe));
        let holds = until_then & time.less(gaps.until);
        let passed = terms.limit.less(gaps.until) | one.less(gaps.until);
        let is_going = found.is_going();
        found.time = L::select(is_going & holds, gaps.until, time);
        let miss = zero.splat(MISS);
        found.verdict = L::select(is_going & holds & passed, miss, found.verdict);
        let (half, twice) = (
            progress.ahead * zero.splat(0.5),
            progress.ahead + progress.ahead,
        );
        let farther = twice.or_smaller(zero.splat(FARTHEST_AHEAD));
        progress.ahead = L::select(holds, farther, half);
    }

    /// The largest sum of absolute coordinates, plus the radius.
    #[inline(always)]
    fn size(&self) -> L {
        let mut size = self.radius.splat(0.0);
        for corner in 0..3 {
            for corners in &self.corners {
                size = size.or_larger(taxicab(corners[corner]));
            }
        }
        for end in 0..N {
            size = size.or_larger(taxicab(self.core_start[end]));
            size = size.or_larger(taxicab(self.core_end[end]));
        }
        size + self.radius
    }
}

impl<L: Lanes> Found<L> {
    #[inline(always)]
    fn is_going(&self) -> L::Mask {
        self.verdict.equals(self.verdict.splat(GOING))
    }
}

impl<L: Lanes, const N: usize, const P: usize> Terms<L, N, P> {
    /// The distance between the nearest points; 0 for what crosses the triangle, and shows rounding.
    #[inline(always)]
    fn measured(&self, nearest: &Separation<L>) -> L {
        let distance = nearest.apart.length();
        let touching = distance.at_most(self.lost);
        if !L::any(touching) {
            return distance;
        }
        let rounding = nearest.size() * distance.splat(LOST);
        let touching = touching & distance.at_most(rounding);
        L::select(touching, distance.splat(0.0), distance)
    }
}
