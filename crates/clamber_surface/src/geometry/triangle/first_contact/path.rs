use super::gaps::{Floors, taxicab};
use super::separation::{Separation, direction};
use super::{CONTACT, FARTHEST_AHEAD, GOING, LOST, MISS, SLOW, STEPS, UNDECIDED};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// One triangle in each lane, still (P = 1) or moving (P = 2), and the same core in all lanes.
pub(super) struct Path<L, const N: usize, const P: usize> {
    /// Corners at the start and, if the triangle moves, at the end.
    pub(super) corners: [[Vector3<L>; 3]; P],
    pub(super) core_start: [Vector3<L>; N],
    pub(super) core_end: [Vector3<L>; N],
    pub(super) radius: L,
    pub(super) tolerance: L,
}

/// The result of each lane so far.
#[derive(Clone, Copy)]
pub(super) struct Found<L> {
    /// [`MISS`], [`CONTACT`] or [`UNDECIDED`]; [`GOING`] as long as none of these is known.
    pub(super) verdict: L,
    /// There is no contact before this time.
    pub(super) time: L,
    /// Corner weights of the triangle's nearest point at that time.
    pub(super) weights: [L; 3],
    pub(super) distance: L,
}

/// Values that are the same at every step.
struct Terms<L, const N: usize, const P: usize> {
    /// Contacts after this time are pruned.
    limit: L,
    floors: Floors<L, N, P>,
    /// Allowance for rounding in a distance.
    lost: L,
    /// Largest distance that counts as a contact.
    near: L,
}

/// The last step, for the look-ahead.
struct Progress<L> {
    time: L,
    distance: L,
    /// Time of the next look-ahead, as a share of the way to the time at which the gap would close.
    ahead: L,
}

impl<L: Lanes, const N: usize, const P: usize> Path<L, N, P> {
    /// The result of each lane, and the number of steps of the slowest lane.
    #[cfg_attr(not(unoptimized), inline(always))]
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
            // A shape that turns or slides closer approaches although no line falls along the current n.
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

    #[cfg_attr(not(unoptimized), inline(always))]
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

    /// The time until which the gap is large enough, and whether the gap falls now. If the gap is too small now, that
    /// time is not later than now.
    #[cfg_attr(not(unoptimized), inline(always))]
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

    #[cfg_attr(not(unoptimized), inline(always))]
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
        // Pruning comes first and may be overruled below, so that it removes no contact that is found.
        let verdict = L::select(terms.limit.less(until), miss, going);
        let verdict = L::select(stuck, undecided, verdict);
        let verdict = if last { undecided } else { verdict };
        let verdict = L::select(touches, contact, verdict);
        L::select(misses, miss, verdict)
    }

    /// Moves `found.time` on with the direction at a later time, the probe time: shortly before the gap would close at
    /// the rate of the last step. If that fails, tries a direction that turns from the direction of `nearest`, at the
    /// beginning of this step, to the direction at the probe time.
    #[cfg_attr(not(unoptimized), inline(always))]
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
    #[cfg_attr(not(unoptimized), inline(always))]
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
    #[cfg_attr(not(unoptimized), inline(always))]
    fn is_going(&self) -> L::Mask {
        self.verdict.equals(self.verdict.splat(GOING))
    }
}

impl<L: Lanes, const N: usize, const P: usize> Terms<L, N, P> {
    /// The distance between the nearest points; 0 if it is no more than rounding error, as where the core crosses the
    /// triangle.
    #[cfg_attr(not(unoptimized), inline(always))]
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
