use super::gaps::taxicab;
use super::separation::direction;
use super::{CONTACT, FARTHEST_AHEAD, GOING, LOST, MISS, SLOW, STEPS, UNDECIDED};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// Per lane a moving triangle; in all lanes the same core.
pub(super) struct Path<L, const N: usize> {
    pub(super) start: [Vector3<L>; 3],
    pub(super) end: [Vector3<L>; 3],
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
    pub(super) time: L,
    pub(super) weights: [L; 3],
    pub(super) distance: L,
}

impl<L: Lanes, const N: usize> Path<L, N> {
    #[inline(always)]
    pub(super) fn advance(&self, limit: L) -> (Found<L>, u32) {
        let zero = limit.splat(0.0);
        let one = zero.splat(1.0);
        let (going, miss) = (zero.splat(GOING), zero.splat(MISS));
        let (contact, undecided) = (zero.splat(CONTACT), zero.splat(UNDECIDED));
        let lost = self.size() * zero.splat(LOST);
        let floors = self.floors();
        let near = self.radius + (self.tolerance - lost).or_larger(lost * zero.splat(4.0));
        let mut found = Found {
            verdict: going,
            time: zero,
            weights: [zero; 3],
            distance: zero,
        };
        let mut ahead = zero.splat(FARTHEST_AHEAD);
        let (mut last_time, mut last_distance) = (zero, zero);
        let mut steps = 0;
        loop {
            steps += 1;
            let is_going = found.verdict.equals(going);
            let nearest = self.separation(found.time);
            let mut distance = nearest.apart.length();
            // What crosses the triangle shows a distance of rounding.
            let touching = distance.at_most(lost);
            if L::any(touching) {
                let touching = touching & distance.at_most(nearest.size() * zero.splat(LOST));
                distance = L::select(touching, zero, distance);
            }
            found.distance = L::select(is_going, distance, found.distance);
            for (kept, weight) in found.weights.iter_mut().zip(nearest.weights) {
                *kept = L::select(is_going, weight, *kept);
            }

            let gaps = self.gaps(direction(nearest.apart, distance), &floors, found.time);
            let mut until = L::select(gaps.from.at_most(found.time), gaps.until, zero);
            if L::any(is_going & until.at_most(found.time)) {
                let upright = nearest.upright();
                let n = direction(upright, upright.length());
                let gaps = self.gaps(n, &floors, found.time);
                let better = gaps.from.at_most(found.time) & until.at_most(found.time);
                until = L::select(better, gaps.until, until);
            }
            let stuck = until.at_most(found.time);
            let is_near = distance.at_most(near);
            let touches = (is_near & (gaps.approaching | stuck)) | distance.at_most(self.radius);
            let misses = one.less(until) & self.radius.less(distance);
            // Pruning comes last, so that it changes no contact that is found.
            let verdict = L::select(limit.less(until), miss, going);
            let verdict = L::select(stuck, undecided, verdict);
            let verdict = if steps < STEPS { verdict } else { undecided };
            let verdict = L::select(touches, contact, verdict);
            let verdict = L::select(misses, miss, verdict);
            found.verdict = L::select(is_going, verdict, found.verdict);
            let is_going = found.verdict.equals(going);
            if !L::any(is_going) {
                return (found, steps);
            }
            let (before, time) = (found.time, until);
            found.time = L::select(is_going, time, found.time);
            if steps < SLOW {
                (last_time, last_distance) = (before, distance);
                continue;
            }

            // Where the gap would be closed if it went on as since the last step.
            let rate = (last_distance - distance) / (before - last_time);
            let closes = before + (distance - self.radius) / rate;
            let closes = L::select(zero.less(rate) & closes.less(one), closes, one);
            let probe = time + (closes - time) * ahead;
            let probe = L::select(time.less(probe), probe, time);
            let apart = self.separation(probe).apart;
            let gaps = self.gaps(direction(apart, apart.length()), &floors, probe);
            let holds = gaps.from.at_most(time) & time.less(gaps.until);
            found.time = L::select(is_going & holds, gaps.until, found.time);
            let passed = is_going & holds & (limit.less(gaps.until) | one.less(gaps.until));
            found.verdict = L::select(passed, miss, found.verdict);
            if !L::any(found.verdict.equals(going)) {
                return (found, steps);
            }
            let (half, twice) = (ahead * zero.splat(0.5), ahead * zero.splat(2.0));
            ahead = L::select(holds, twice.or_smaller(zero.splat(FARTHEST_AHEAD)), half);
            (last_time, last_distance) = (before, distance);
        }
    }

    /// The largest sum of absolute coordinates, plus the radius.
    #[inline(always)]
    fn size(&self) -> L {
        let mut size = self.radius.splat(0.0);
        for corner in 0..3 {
            size = size.or_larger(taxicab(self.start[corner]));
            size = size.or_larger(taxicab(self.end[corner]));
        }
        for end in 0..N {
            size = size.or_larger(taxicab(self.core_start[end]));
            size = size.or_larger(taxicab(self.core_end[end]));
        }
        size + self.radius
    }
}
