//! First contact of a moving triangle with a moving sphere or capsule, by directional conservative advancement.
//!
//! All corners move on straight lines, and so do the ends of the core: the sphere's centre, or the two ends of the
//! capsule's segment. For a fixed direction n, |n| <= 1, the gap `s(t) = min n.(p_j(t) - a_i(t))` over ends p_j and
//! corners a_i is at most the distance at t. It is a minimum of linear functions of t. A linear function that is not
//! below the radius at two times is not below it at any time between them, so two times certify the whole interval,
//! however poor n is. Each step takes n from the closest points at the time reached, and goes on to the time at which
//! the first line falls to the radius. (Conservative advancement: Mirtich 1996, *Impulse-based Dynamic Simulation of
//! Rigid Body Systems*, 2.3, which uses a bound on the speed. A direction and linear paths in place of that bound keep
//! the steps long where shapes slide along each other and where vertices are fast.)
//!
//! Rotation is the hard case. A corner that turns about a slow one, or the far end of a capsule that swings, moves fast
//! although the gap hardly changes. Along the current n, its line falls to the radius long before the gap closes; along
//! the n of a later time, the gap is still large now. So a triangle that takes more than a few steps looks ahead: it
//! takes n at a time shortly before the gap would close at the rate seen. If the gap along that n is large enough from
//! now until then, it stays so until some time after that. If the rotation is too fast for either direction, n turns
//! with it, linearly from the current n to the later one. The gap of an end and a corner is then quadratic in time, and
//! never less than the least of its three coefficients in the Bernstein basis: `n0.x0`, `(n0.x1 + n1.x0) / 2` and
//! `n1.x1`, for directions n0, n1 and vectors x0, x1 from the corner to the end. Turning n costs a part of the gap that
//! is of second order in the time, so the rotation of a long lever takes a dozen steps instead of a hundred.
//!
//! All arithmetic is in f64, relative to the start of the core. Let u = 2^-53, and m the sum of the absolute
//! coordinates of an end or a corner. Its relative position is off by at most 2 u m. The product with n adds up to 4 u
//! m, and the difference of two such products up to 2 u of both. The sum is below 16 u m; [`LOST`] m is twice that.
//! Both ends of every line have to exceed the radius by [`LOST`] m of the core's end and by [`LOST`] m of the corner;
//! the radius adds the same share of itself. The coefficients of a turning n use positions between the two ends, which
//! are off by 6 u m more: the sum is below 24 u m, and the same margin covers it. Let M be the largest m plus the
//! radius. So:
//!
//! - A reported time is never later than the first contact, and a reported miss has no contact. Lines are given by
//!   their ends (`h0 (1 - t) + h1 t`), so the only time that is rounded on the way to a certificate is the root of a
//!   line. It is rounded to the side that shortens the certified interval.
//! - A contact is reported at a distance of at most the radius plus the tolerance. A tolerance below `4 LOST M` counts
//!   as `4 LOST M`.
//! - If rounding allows no step along the n of the closest points, n is made perpendicular to the edges that these
//!   points lie within. An edge is then no longer a lever that turns rounding into distance.
//! - There is no step by distance over speed (additive CCD). It would need the true distance. The measured distance may
//!   be larger, in slivers by more than rounding, and made such steps report times that were late.
//! - If neither contact nor miss can be shown within [`STEPS`] steps, or if rounding allows no step, the time reached
//!   is reported as a contact and flagged undecided.

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

/// Largest number of steps for a triangle. Most triangles take two to five, fast turns a dozen or two. In a million
/// motions made to be hard, 15 take all steps, all of them with triangles that are nearly lines.
pub(crate) const STEPS: u32 = 256;

/// From this step on, the solver also looks ahead for directions.
const SLOW: u32 = 4;

/// Farthest time of a look-ahead, as a share of the way to the time at which the gap would close. A value nearer to 1
/// leaves less of the gap, and fails more often.
const FARTHEST_AHEAD: f64 = 0.875;

/// Allowance for rounding in a gap, as a share of the lengths involved: see the module's docs.
const LOST: f64 = 1.0 / (1u64 << 48) as f64;

/// Factor that rounds a quotient down: covers three roundings of the quotient, and the roundings of the factor itself.
const ROUNDED_DOWN: f64 = 1.0 - 8.0 * f64::EPSILON;

/// Factor that rounds a quotient up, by as much as [`ROUNDED_DOWN`] rounds down.
const ROUNDED_UP: f64 = 1.0 + 8.0 * f64::EPSILON;

/// A time after the end of the motion, which is never reached.
const NEVER: f64 = 2.0;

/// The first contact of a moving triangle with a moving core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contact {
    /// Weights of the corners.
    pub(crate) barycentric: DVec3,
    /// Share of the motion, 0..=1.
    pub(crate) time: f64,
    /// Distance from the triangle to the core at that time.
    pub(crate) distance: f64,
    /// True if neither a contact nor its absence could be shown.
    pub(crate) undecided: bool,
}

/// The first contact of a triangle up to the time `limit`, 0..=1, and the number of steps that it took. The triangle
/// stands still (P = 1) or moves from the first corners to the last (P = 2).
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

/// [`first_contact`] for coordinates in f64, relative to the start of the core.
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

/// Verdict of a lane that is not decided yet.
const GOING: f64 = 0.0;

/// Verdict: there is no contact up to the time limit.
const MISS: f64 = 1.0;

/// Verdict: there is a contact.
const CONTACT: f64 = 2.0;

/// Verdict: neither a contact nor its absence could be shown.
const UNDECIDED: f64 = 3.0;
