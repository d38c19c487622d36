//! Measures how far hands have to reach at a seat, and on the way to the next one.

use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::GraphConfig;

/// A grip is searched within twice the climber's reach and this many of its radii.
const SEARCH_BEYOND_REACH: f64 = 2.5;

/// How far a hand has to reach from the ball of a seat, metres; infinite if there is no grip within twice the climber's
/// reach and some of its radii. `holds` is the skin that can be gripped.
pub(super) fn arm(holds: &SkinnedSurface, seat: DVec3, config: &GraphConfig) -> f64 {
    if config.reach() < 0.0 {
        return f64::INFINITY;
    }
    let radius = config.radius();
    let longest = radius + 2.0 * config.reach() + SEARCH_BEYOND_REACH * radius;
    let hit = holds.in_world().closest_point(seat, longest);
    hit.map_or(f64::INFINITY, |hit| (hit.distance - radius).max(0.0))
}

/// Error up to which the longest reach on a straight way is computed, metres. Smaller values need more closest-point
/// queries.
pub(crate) const REACH_PRECISION: f64 = 0.004;

/// How far a hand has to reach at most on the straight way between two seats, from the arms at both ends: too long by
/// at most [`REACH_PRECISION`], and never too short.
///
/// A hand's reach changes by no more than the ball moves. So the ends give an upper bound for the way between them, and
/// halving the way narrows the bound. A way whose bound is at most `enough` plus [`REACH_PRECISION`] is not halved.
pub(super) fn arm_between(
    seats: [DVec3; 2],
    arms: [f64; 2],
    enough: f64,
    arm_at: &dyn Fn(DVec3) -> f64,
) -> f64 {
    let most = arms[0].max(arms[1]);
    let bound = longest(seats, arms);
    if !bound.is_finite() || bound <= enough + REACH_PRECISION || bound - most <= REACH_PRECISION {
        return bound;
    }
    let middle = seats[0].midpoint(seats[1]);
    let arm = arm_at(middle);
    let first = arm_between([seats[0], middle], [arms[0], arm], enough, arm_at);
    let second = arm_between([middle, seats[1]], [arm, arms[1]], enough, arm_at);
    first.max(second)
}

/// An upper bound of a hand's reach on a straight way, from the arms at both ends.
pub(super) fn longest(seats: [DVec3; 2], arms: [f64; 2]) -> f64 {
    let between = 0.5 * (arms[0] + arms[1] + seats[0].distance(seats[1]));
    arms[0].max(arms[1]).max(between)
}
