//! First contact of a moving triangle with a moving sphere or capsule, by directional conservative
//! advancement.
//!
//! All corners move on straight lines, and so do the ends of the core, the sphere's centre or the
//! capsule's segment. For a fixed direction n, |n| <= 1, the gap
//! `s(t) = min n.(p_j(t) - a_i(t))` over ends p_j and corners a_i is at most the distance at t, and it
//! is a minimum of linear functions: that two values of a line are not below the radius certifies all
//! times between them, however poor n is. Each step takes n from the closest points at the time
//! reached and goes on to where the first line meets the radius. (Conservative advancement: Mirtich
//! 1996, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 2.3; with a direction and linear
//! vertex paths in place of a bound on the speed it neither creeps beside what it slides along nor
//! slows down where vertices are fast.)
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

/// Most steps for a triangle. What is not flat on the path takes two or three, a near miss that turns
/// some twenty; where more are needed, progress is by rounding.
pub(crate) const STEPS: u32 = 64;

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
        let (going, miss) = (zero.splat(GOING), zero.splat(MISS));
        let (contact, undecided) = (zero.splat(CONTACT), zero.splat(UNDECIDED));
        let lost = self.size() * zero.splat(LOST);
        let floor = self.radius + lost;
        let near = self.radius + (self.tolerance - lost).or_larger(lost * zero.splat(4.0));
        let mut found = Found {
            verdict: going,
            time: zero,
            weights: [zero; 3],
            distance: zero,
        };
        let mut steps = 0;
        loop {
            steps += 1;
            let is_going = found.verdict.equals(going);
            let (weights, apart) = self.separation(found.time);
            let distance = apart.length();
            found.distance = L::select(is_going, distance, found.distance);
            for (kept, weight) in found.weights.iter_mut().zip(weights) {
                *kept = L::select(is_going, weight, *kept);
            }

            // Shorter than 1 for all rounding; no direction at all where they touch.
            let shrink = zero.splat(ROUNDED_DOWN) / distance;
            let n = Vector3::select(zero.less(distance), apart * shrink, apart);
            let gaps = self.gaps(n, floor, found.time);
            let stuck = gaps.until.at_most(found.time);
            let is_near = distance.at_most(near);
            let touches = (is_near & (gaps.approaching | stuck)) | distance.at_most(self.radius);
            let misses = zero.splat(NEVER).at_most(gaps.until) & self.radius.less(distance);
            // Pruning comes last, so that it changes no contact that is found.
            let verdict = L::select(limit.less(gaps.until), miss, going);
            let verdict = L::select(stuck, undecided, verdict);
            let verdict = if steps < STEPS { verdict } else { undecided };
            let verdict = L::select(touches, contact, verdict);
            let verdict = L::select(misses, miss, verdict);
            found.verdict = L::select(is_going, verdict, found.verdict);
            let is_going = found.verdict.equals(going);
            if !L::any(is_going) {
                return (found, steps);
            }
            found.time = L::select(is_going, gaps.until, found.time);
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

    /// How the gap along `n` goes on from `time`.
    #[inline(always)]
    fn gaps(&self, n: Vector3<L>, floor: L, time: L) -> Gaps<L> {
        let zero = time.splat(0.0);
        let mut until = zero.splat(NEVER);
        let (mut least, mut slope) = (zero.splat(f64::INFINITY), zero);
        for end in 0..N {
            let core_start = n.dot(self.core_start[end]) - floor;
            let core_end = n.dot(self.core_end[end]) - floor;
            for corner in 0..3 {
                let h0 = core_start - n.dot(self.start[corner]);
                let h1 = core_end - n.dot(self.end[corner]);
                until = until.or_smaller(until_negative(h0, h1, time));
                let change = h1 - h0;
                let now = h0 + change * time;
                let less = now.less(least);
                least = L::select(less, now, least);
                slope = L::select(less, change, slope);
            }
        }
        Gaps {
            until,
            approaching: slope.less(zero),
        }
    }
}

struct Gaps<L: Lanes> {
    /// No line is below its floor from the time asked for until this one; not later than the time
    /// asked for if one is below it there already.
    until: L,
    /// The line that is lowest now falls.
    approaching: L::Mask,
}

/// Until when `h0 (1 - t) + h1 t` is not negative, from `time` on; 0 if it is at `time`.
#[inline(always)]
fn until_negative<L: Lanes>(h0: L, h1: L, time: L) -> L {
    let zero = h0.splat(0.0);
    let root = h0 / (h0 - h1);
    let (falls_through, starts_below) = (h1.less(zero), h0.less(zero));
    let rising = (root * zero.splat(ROUNDED_UP)).at_most(time);
    let of_rising = L::select(rising, zero.splat(NEVER), zero);
    let of_falling = L::select(starts_below, zero, root * zero.splat(ROUNDED_DOWN));
    let of_starting_below = L::select(falls_through, zero, of_rising);
    let not_falling = L::select(starts_below, of_starting_below, zero.splat(NEVER));
    L::select(falls_through, of_falling, not_falling)
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
