//! First contact of a moving triangle with a moving sphere or capsule, by directional conservative
//! advancement.
//!
//! All corners move on straight lines, and so do the ends of the core, the sphere's centre or the
//! capsule's segment. For a fixed direction n, |n| <= 1, the gap
//! `s(t) = min n.(p_j(t) - a_i(t))` over ends p_j and corners a_i is at most the distance at t, and it
//! is a minimum of linear functions: that two values of a line are not below the radius certifies all
//! times between them, however poor n is. Each step takes n from the closest points at the time
//! reached and goes on to where the first line meets the radius, or as far as the distance lasts at the
//! largest relative speed, if that is farther: as it may be where n is poor. (Conservative advancement:
//! Mirtich 1996, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 2.3. With a direction and
//! linear paths in place of the speed alone it neither creeps beside what it slides along nor slows down
//! where vertices are fast.)
//!
//! A corner that turns about a slow one, or the far end of a capsule that swings, is fast where nothing
//! happens: along n of now, its line falls long before the gap closes. Along n of later it is still high
//! now. So what takes more than a few steps looks ahead, to shortly before the gap would close at the
//! rate seen: if the gap along n of then is large enough from now until then, it is so until later still.
//!
//! In f64, relative to the start of the core. Let u = 2^-53 and M the largest sum of absolute
//! coordinates of any point, plus the radius. Relative positions are off by 2 u M at most, the
//! products of a gap by 4 u M each, their difference by 2 u M more: below 16 u M, twice which is
//! [`LOST`] M, and every line has to keep so much more than the radius. So:
//!
//! - A time is never later than first contact, and a miss has none. Lines are given by their ends
//!   (`h0 (1 - t) + h1 t`), so that no time is rounded on the way to a certificate but the root of a
//!   line, and that towards the time before.
//! - A contact is reported at a distance of at most radius + tolerance, which counts as no less than
//!   `4 LOST M`.
//! - Where neither can be shown within [`STEPS`] steps, or where rounding allows no step, the time
//!   reached is reported as a contact, and said to be undecided.

mod eight;

pub(crate) use eight::advance_eight;

use glam::{DVec3, Vec3};

use super::point::{nearest_to_origin, weighted};
use super::segment::{nearest_on_axis, nearest_to_segment, point_of_axis};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;
use crate::geometry::widen;

/// Most steps for a triangle. Most take two or three; where so many are not enough, progress is by
/// rounding.
pub(crate) const STEPS: u32 = 64;

/// From this step on, directions are taken from ahead as well.
const SLOW: u32 = 4;

/// How far ahead such a direction is sought at most, as a share of the way to where the gap would close.
/// Nearer to 1 leaves less of the gap, and fails more often.
const FARTHEST_AHEAD: f64 = 0.875;

/// What arithmetic may take off a gap, as a share of the lengths involved. See above.
const LOST: f64 = 1.0 / (1u64 << 48) as f64;

/// Pays for three roundings of a quotient, and for those of the factor itself.
const ROUNDED_DOWN: f64 = 1.0 - 8.0 * f64::EPSILON;
const ROUNDED_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

/// A time that is never reached.
const NEVER: f64 = 2.0;

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
}

impl<const N: usize> MovingCore<N> {
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

/// Where a moving triangle and a moving core first touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact {
    /// Weights of the corners.
    pub(crate) barycentric: DVec3,
    /// 0..1.
    pub(crate) time: f64,
    /// From the triangle to the core at that time.
    pub(crate) distance: f64,
    /// Neither contact nor its absence could be shown.
    pub(crate) undecided: bool,
}

/// The first contact up to the time `limit`, 0..1, and the steps that it took.
pub(crate) fn advance<const N: usize>(
    start: [Vec3; 3],
    end: [Vec3; 3],
    core: &MovingCore<N>,
    limit: f64,
) -> (Option<Contact>, u32) {
    let origin = widen(core.origin);
    let relative = |corners: [Vec3; 3]| corners.map(|p| Vector3::from(widen(p) - origin));
    let path = Path {
        start: relative(start),
        end: relative(end),
        core_start: core.start.map(Vector3::from),
        core_end: core.end.map(Vector3::from),
        radius: core.radius,
        tolerance: core.tolerance,
    };
    let (found, steps) = path.advance(limit);
    let contact = (found.verdict != MISS).then(|| Contact {
        barycentric: DVec3::from_array(found.weights),
        time: found.time,
        distance: found.distance,
        undecided: found.verdict == UNDECIDED,
    });
    (contact, steps)
}

const GOING: f64 = 0.0;
const MISS: f64 = 1.0;
const CONTACT: f64 = 2.0;
const UNDECIDED: f64 = 3.0;

/// Per lane a moving triangle; in all lanes the same core.
struct Path<L, const N: usize> {
    start: [Vector3<L>; 3],
    end: [Vector3<L>; 3],
    core_start: [Vector3<L>; N],
    core_end: [Vector3<L>; N],
    radius: L,
    tolerance: L,
}

/// What is known of each lane.
#[derive(Clone, Copy)]
struct Found<L> {
    /// One of [`MISS`], [`CONTACT`], [`UNDECIDED`]; [`GOING`] until one is known.
    verdict: L,
    time: L,
    weights: [L; 3],
    distance: L,
}

impl<L: Lanes, const N: usize> Path<L, N> {
    #[inline(always)]
    fn advance(&self, limit: L) -> (Found<L>, u32) {
        let zero = limit.splat(0.0);
        let one = zero.splat(1.0);
        let (going, miss) = (zero.splat(GOING), zero.splat(MISS));
        let (contact, undecided) = (zero.splat(CONTACT), zero.splat(UNDECIDED));
        let lost = self.size() * zero.splat(LOST);
        let floor = self.radius + lost;
        let speed = self.speed() * zero.splat(ROUNDED_UP) + lost;
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
            let (weights, apart) = self.separation(found.time);
            let distance = apart.length();
            // What crosses the triangle shows a distance of rounding.
            let distance = L::select(lost.less(distance), distance, zero);
            found.distance = L::select(is_going, distance, found.distance);
            for (kept, weight) in found.weights.iter_mut().zip(weights) {
                *kept = L::select(is_going, weight, *kept);
            }

            let gaps = self.gaps(direction(apart, distance), floor, found.time);
            let until = L::select(gaps.from.at_most(found.time), gaps.until, zero);
            let slowest = (distance - floor - lost) / speed * zero.splat(ROUNDED_DOWN);
            let slowest = (found.time + slowest) * zero.splat(ROUNDED_DOWN);
            let until = until.or_larger(slowest);
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
            let closes = before + (distance - floor) / rate;
            let closes = L::select(zero.less(rate) & closes.less(one), closes, one);
            let probe = time + (closes - time) * ahead;
            let probe = L::select(time.less(probe), probe, time);
            let (_, apart) = self.separation(probe);
            let gaps = self.gaps(direction(apart, apart.length()), floor, probe);
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

    /// The most by which a corner and an end of the core come nearer, of all pairs.
    #[inline(always)]
    fn speed(&self) -> L {
        let mut squared = self.radius.splat(0.0);
        for end in 0..N {
            let of_core = self.core_end[end] - self.core_start[end];
            for corner in 0..3 {
                let way = of_core - (self.end[corner] - self.start[corner]);
                squared = squared.or_larger(way.length_squared());
            }
        }
        squared.sqrt()
    }

    /// Weights of the corners that give the triangle's point nearest to the core, and the vector from
    /// there to the core.
    #[inline(always)]
    fn separation(&self, time: L) -> ([L; 3], Vector3<L>) {
        let a = between(self.start[0], self.end[0], time);
        let b = between(self.start[1], self.end[1], time);
        let c = between(self.start[2], self.end[2], time);
        let first = between(self.core_start[0], self.core_end[0], time);
        let from_first = [a - first, b - first, c - first];
        if N == 1 {
            let nearest = nearest_to_origin(from_first);
            let zero = time.splat(0.0);
            let origin = Vector3 {
                x: zero,
                y: zero,
                z: zero,
            };
            return (
                nearest.weights,
                origin - weighted(from_first, nearest.weights),
            );
        }
        let last = between(self.core_start[N - 1], self.core_end[N - 1], time);
        let axis = last - first;
        let from_last = [a - last, b - last, c - last];
        let nearest = nearest_to_segment(from_first, from_last, axis);
        let met = weighted(from_first, nearest.weights);
        let near = point_of_axis(axis, nearest_on_axis(axis, met));
        (nearest.weights, near - met)
    }

    /// When the gap along `n` is not below `floor`, and whether it falls at `time`.
    #[inline(always)]
    fn gaps(&self, n: Vector3<L>, floor: L, time: L) -> Gaps<L> {
        let zero = time.splat(0.0);
        let never = zero.splat(NEVER);
        let (mut from, mut until) = (zero, never);
        let (mut least, mut slope) = (zero.splat(f64::INFINITY), zero);
        for end in 0..N {
            let core_start = n.dot(self.core_start[end]) - floor;
            let core_end = n.dot(self.core_end[end]) - floor;
            for corner in 0..3 {
                let h0 = core_start - n.dot(self.start[corner]);
                let h1 = core_end - n.dot(self.end[corner]);
                // Where the line `h0 (1 - t) + h1 t` passes through 0, if it does.
                let root = h0 / (h0 - h1);
                let (low_first, low_last) = (h0.less(zero), h1.less(zero));
                let begin = L::select(low_last, never, root * zero.splat(ROUNDED_UP));
                from = from.or_larger(L::select(low_first, begin, zero));
                let end = L::select(low_first, zero, root * zero.splat(ROUNDED_DOWN));
                until = until.or_smaller(L::select(low_last, end, never));
                let change = h1 - h0;
                let now = h0 + change * time;
                let less = now.less(least);
                least = L::select(less, now, least);
                slope = L::select(less, change, slope);
            }
        }
        Gaps {
            from,
            until,
            approaching: slope.less(zero),
        }
    }
}

/// When the gap along a direction is large enough.
struct Gaps<L: Lanes> {
    /// From here, ...
    from: L,
    /// ... until here, which may be [`NEVER`] for both.
    until: L,
    /// The line that is lowest at the time asked for falls.
    approaching: L::Mask,
}

/// Shorter than 1 for all rounding; zero where the distance is.
#[inline(always)]
fn direction<L: Lanes>(apart: Vector3<L>, distance: L) -> Vector3<L> {
    let zero = distance.splat(0.0);
    let shrink = zero.splat(ROUNDED_DOWN) / distance;
    Vector3::select(zero.less(distance), apart * shrink, apart * zero)
}

#[inline(always)]
fn taxicab<L: Lanes>(v: Vector3<L>) -> L {
    let absolute = |x: L| x.or_larger(-x);
    absolute(v.x) + absolute(v.y) + absolute(v.z)
}

/// `start` at time 0.
#[inline(always)]
fn between<L: Lanes>(start: Vector3<L>, end: Vector3<L>, time: L) -> Vector3<L> {
    start + (end - start) * time
}
