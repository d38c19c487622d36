//! First contact of a moving triangle with a moving sphere or capsule, by directional conservative
//! advancement.
//!
//! All corners move on straight lines, and so do the ends of the core, the sphere's centre or the
//! capsule's segment. For a fixed direction n, |n| <= 1, the gap
//! `s(t) = min n.(p_j(t) - a_i(t))` over ends p_j and corners a_i is at most the distance at t, and it
//! is a minimum of linear functions: that two values of a line are not below the radius certifies all
//! times between them, however poor n is. Each step takes n from the closest points at the time
//! reached and goes on to where the first line meets the radius. (Conservative advancement: Mirtich
//! 1996, *Impulse-based Dynamic Simulation of Rigid Body Systems*, 2.3. With a direction and linear paths
//! in place of a bound on the speed it neither creeps beside what it slides along nor slows down where
//! vertices are fast.)
//!
//! A corner that turns about a slow one, or the far end of a capsule that swings, is fast where nothing
//! happens: along n of now, its line falls long before the gap closes. Along n of later it is still high
//! now. So what takes more than a few steps looks ahead, to shortly before the gap would close at the
//! rate seen: if the gap along n of then is large enough from now until then, it is so until later still.
//! Where the turn is too fast for either, n turns with it, linearly from that of now to that of then. The
//! gap of an end and a corner is quadratic then, and nowhere less than the least of its three
//! coefficients in the Bernstein basis: `n0.x0`, `(n0.x1 + n1.x0) / 2` and `n1.x1`, for directions n0, n1
//! and ways x0, x1 from the corner to the end. What turning takes from the gap is of second order in the
//! time, so that a turn of a long lever takes a dozen steps in place of a hundred.
//!
//! In f64, relative to the start of the core. Let u = 2^-53 and m the sum of absolute coordinates of an
//! end or a corner. Its relative position is off by 2 u m at most, the product with n by 4 u m more, and
//! the difference of two such products by 2 u of both: below 16 u m, twice which is [`LOST`] m, and
//! the ends of every line have to keep so much more than the radius (for which the same is added), of
//! the core's end and of the corner. A coefficient of a turning n is of places between, which are off by
//! 6 u m more: below 24 u m, and has to keep as much. Let M be the largest m and the radius. So:
//!
//! - A time is never later than first contact, and a miss has none. Lines are given by their ends
//!   (`h0 (1 - t) + h1 t`), so that no time is rounded on the way to a certificate but the root of a
//!   line, and that towards the time before.
//! - A contact is reported at a distance of at most radius + tolerance, which counts as no less than
//!   `4 LOST M`.
//! - Where rounding allows no step along n of the closest points, n is made upright on the edges that they
//!   lie within: a lever of their length no longer turns rounding into distance.
//! - A step by distance over speed (additive CCD) would need the true distance; what is measured may be
//!   larger, in slivers by more than rounding, and did make times late. There is none.
//! - Where neither can be shown within [`STEPS`] steps, or where rounding allows no step, the time
//!   reached is reported as a contact, and said to be undecided.

mod core;
mod eight;
mod gaps;
mod path;
mod separation;

pub(crate) use self::core::MovingCore;
pub(crate) use eight::first_contact_of_eight;

use glam::{DVec3, Vec3};

use self::path::Path;
use crate::geometry::vector3::Vector3;
use crate::geometry::widen;

/// Most steps for a triangle. Most take two to five, fast turns a dozen or two; of a million motions made
/// to be hard 15 take all, all of them with triangles that are all but lines.
pub(crate) const STEPS: u32 = 256;

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

/// The first contact up to the time `limit`, 0..1, with a triangle that stands still (P = 1) or moves from the first
/// corners to the last (P = 2), and the steps that it took.
pub(crate) fn first_contact<const N: usize, const P: usize>(
    corners: [[Vec3; 3]; P],
    core: &MovingCore<N>,
    limit: f64,
) -> (Option<Contact>, u32) {
    let origin = widen(core.origin);
    let relative = |corners: [Vec3; 3]| corners.map(|p| Vector3::from(widen(p) - origin));
    let path = Path {
        corners: corners.map(relative),
        core_start: core.start.map(Vector3::from),
        core_end: core.end.map(Vector3::from),
        radius: core.radius,
        tolerance: core.tolerance,
    };
    of_path(&path, limit)
}

/// [`first_contact`] for what is in f64 already, relative to the start of the core.
pub(crate) fn first_contact_relative<const N: usize>(
    corners: [[DVec3; 3]; 2],
    core: [[DVec3; N]; 2],
    [radius, tolerance]: [f64; 2],
    limit: f64,
) -> Option<Contact> {
    let [core_start, core_end] = core.map(|ends| ends.map(Vector3::from));
    let path = Path {
        corners: corners.map(|corners| corners.map(Vector3::from)),
        core_start,
        core_end,
        radius,
        tolerance,
    };
    of_path(&path, limit).0
}

fn of_path<const N: usize, const P: usize>(
    path: &Path<f64, N, P>,
    limit: f64,
) -> (Option<Contact>, u32) {
    let (found, steps) = path.first_contact(limit);
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
