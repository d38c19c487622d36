//! How far hands have to reach from a seat, and on the way to the next one.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::GraphConfig;

/// Hands are looked for within so many metres more than the climber's reach, at least.
const BEYOND: f64 = 1.0;

/// How far a hand has to reach from a ball, metres; infinite if there is nothing to grip within twice the climber's reach and a
/// metre.
pub(super) fn arm(surface: &SkinnedSurface, seat: DVec3, config: &GraphConfig) -> f64 {
    if config.reach() < 0.0 {
        return f64::INFINITY;
    }
    let radius = config.radius();
    let longest = 2.0 * config.reach() + BEYOND;
    let near = [0.05 * radius, config.reach(), longest];
    near.into_iter()
        .find_map(|reach| {
            let ball = WorldCapsule::ball(seat, radius + reach);
            let mut nearest = f64::INFINITY;
            surface.in_world().visit_overlap_capsule(&ball, |hit| {
                if (config.can_grip)(&hit.tag) {
                    nearest = nearest.min(hit.distance);
                }
            });
            nearest.is_finite().then(|| (nearest - radius).max(0.0))
        })
        .unwrap_or(f64::INFINITY)
}

/// The longest reach on a straight way is known to this much, metres.
pub(super) const EXACT: f64 = 0.004;

/// How far a hand has to reach at most on the straight way between two seats, from the arms at both ends: too long by at most
/// [`EXACT`], and never too short.
///
/// A hand's reach changes by no more than the ball moves. So the ends bound what is between them, and halving the way narrows
/// the bound. A way on which no bound exceeds `enough` by more is not halved.
pub(super) fn arm_between(
    seats: [DVec3; 2],
    arms: [f64; 2],
    enough: f64,
    arm_at: &dyn Fn(DVec3) -> f64,
) -> f64 {
    let most = arms[0].max(arms[1]);
    let bound = longest(seats, arms);
    if !bound.is_finite() || bound <= enough + EXACT || bound - most <= EXACT {
        return bound;
    }
    let middle = seats[0].midpoint(seats[1]);
    let arm = arm_at(middle);
    let first = arm_between([seats[0], middle], [arms[0], arm], enough, arm_at);
    let second = arm_between([middle, seats[1]], [arm, arms[1]], enough, arm_at);
    first.max(second)
}

/// A bound on how far a hand has to reach on a straight way, from the arms at both ends.
pub(super) fn longest(seats: [DVec3; 2], arms: [f64; 2]) -> f64 {
    let between = 0.5 * (arms[0] + arms[1] + seats[0].distance(seats[1]));
    arms[0].max(arms[1]).max(between)
}
