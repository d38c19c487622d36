//! Entries: patches onto which a climber gets from the ground.

use clamber_climber::ClimberConfig;
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::Patch;
use crate::GraphConfig;
use crate::survey::Survey;

/// A patch onto which a climber gets from the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub struct Entry {
    /// The patch that the climber gets onto: an index into [`ClimbGraph::patches`](crate::ClimbGraph::patches).
    pub patch: usize,
    /// Height above the ground of the middle of the climber's ball on `patch`, metres: at the lowest place of the patch
    /// that it gets onto from the ground.
    pub height: f64,
    /// The largest speed at which the climber's hands pass that lowest place in a jump from the ground at walking
    /// speed, metres per second. 0 if they reach it from the ground without a jump.
    pub speed: f64,
}

/// Number of directions in which a jump forwards to a patch is tried. More find more entries between obstacles, and
/// cost more.
const JUMP_DIRECTIONS: u32 = 16;

/// The patches to which a jump leads through free space: straight up to where hands reach, or forwards at walking
/// speed. Patches on which a climber cannot stand are left out if hands do not catch them.
pub(super) fn entries(survey: &Survey, patches: &[Patch], patch_of: &[u32]) -> Vec<Entry> {
    let jumps = Jumps::new(survey);
    let highest = highest_entry(&survey.config);
    let mut lowest = vec![f64::INFINITY; patches.len()];
    for (piece, patch) in survey.pieces.iter().zip(patch_of) {
        let (Some(seat), Some(lowest)) = (piece.seat, lowest.get_mut(*patch as usize)) else {
            continue;
        };
        let height = seat.dot(jumps.up) - survey.config.ground;
        let is_new = height <= highest && height < *lowest;
        if is_new && (jumps.is_free_below(seat) || jumps.lead_forwards_to(seat)) {
            *lowest = height;
        }
    }
    let found = lowest.into_iter().enumerate();
    let found = found.filter(|(_, height)| height.is_finite());
    let found = found.map(|(patch, height)| Entry {
        patch,
        height,
        speed: speed_at(&survey.config, height),
    });
    found
        .filter(|entry| patches[entry.patch].can_stand || entry.is_caught(&survey.config.climber))
        .collect()
}

impl Entry {
    /// True if a jump passes this place slowly enough for hands to catch it.
    pub(super) fn is_caught(&self, climber: &ClimberConfig) -> bool {
        climber
            .grip
            .is_some_and(|grip| self.speed <= grip.catch_speed)
    }
}

/// The largest speed of a jump from the ground at the lowest point from which hands reach a place. `height` is the
/// place's height above the ground.
fn speed_at(config: &GraphConfig, height: f64) -> f64 {
    let rises = height - config.radius() - config.reach().max(0.0);
    if rises <= 0.0 {
        return 0.0;
    }
    let (climber, ground) = (&config.climber, &config.climber.ground);
    let squared = ground.jump_speed * ground.jump_speed - 2.0 * climber.gravity.length() * rises;
    libm::hypot(libm::sqrt(squared.max(0.0)), ground.walk_speed)
}

/// The highest middle of a climber's ball at a place that its hands reach with a jump from the ground, metres above the
/// ground.
pub(crate) fn highest_entry(config: &GraphConfig) -> f64 {
    let climber = &config.climber;
    let gravity = climber.gravity.length();
    let jump = if gravity > 0.0 {
        0.5 * climber.ground.jump_speed * climber.ground.jump_speed / gravity
    } else {
        f64::INFINITY
    };
    config.radius() + jump + config.reach().max(0.0)
}

/// Distance between two tests of a ball along a jump, as a share of its radius. Longer steps could pass through thin
/// skin.
const TEST_STEP: f64 = 0.5;

/// Depth in skin up to which a ball on its way still counts as free, as a share of its radius. It is more than the 0.02
/// that seats allow.
const FREE_BALL_DEPTH: f64 = 0.03;

/// Near the end of a jump, within this share of the radius, the ball is not tested: it touches the skin of its end
/// there.
const UNTESTED_END: f64 = 0.5;

/// Tests jumps from the ground.
struct Jumps<'a> {
    surface: &'a SkinnedSurface,
    up: DVec3,
    ground: f64,
    radius: f64,
    /// Upward speed at the take-off, metres per second.
    rise: f64,
    /// Walking speed at the take-off, metres per second.
    walk: f64,
    /// Acceleration of gravity, metres per second squared.
    gravity: f64,
}

impl<'a> Jumps<'a> {
    fn new(survey: &'a Survey) -> Self {
        let climber = &survey.config.climber;
        Self {
            surface: &survey.surface,
            up: climber.up(),
            ground: survey.config.ground,
            radius: survey.config.radius(),
            rise: climber.ground.jump_speed,
            walk: climber.ground.walk_speed,
            gravity: climber.gravity.length(),
        }
    }

    fn is_free(&self, place: DVec3) -> bool {
        let hit = self
            .surface
            .in_world()
            .closest_point(place, self.radius * (1.0 - FREE_BALL_DEPTH));
        hit.is_none()
    }

    fn is_free_below(&self, seat: DVec3) -> bool {
        let way = seat.dot(self.up) - self.ground - self.radius;
        let steps = (way / (TEST_STEP * self.radius)).ceil().max(1.0);
        (1..=steps as u32)
            .all(|step| self.is_free(seat - self.up * (way * f64::from(step) / steps)))
    }

    /// True if a jump at walking speed leads to a seat, on its way up or down.
    fn lead_forwards_to(&self, seat: DVec3) -> bool {
        let height = seat.dot(self.up) - self.ground - self.radius;
        let under = self.rise * self.rise - 2.0 * self.gravity * height;
        if self.gravity <= 0.0 || under < 0.0 {
            return false;
        }
        let ahead = self.up.any_orthonormal_vector();
        let aside = self.up.cross(ahead);
        let times = [-1.0, 1.0].map(|sign| (self.rise + sign * libm::sqrt(under)) / self.gravity);
        (0..JUMP_DIRECTIONS).any(|k| {
            let angle = core::f64::consts::TAU * f64::from(k) / f64::from(JUMP_DIRECTIONS);
            let level = ahead * libm::cos(angle) + aside * libm::sin(angle);
            let jump = |time: &f64| *time > 0.0 && self.is_arc_free(seat, level, *time);
            times.iter().any(jump)
        })
    }

    /// True if the path of a jump that arrives at `seat` after `time` seconds is free of skin.
    fn is_arc_free(&self, seat: DVec3, level: DVec3, time: f64) -> bool {
        let fastest = self.rise.max(self.rise - self.gravity * time) + self.walk;
        let steps = (fastest * time / (TEST_STEP * self.radius)).ceil().max(1.0);
        (1..=steps as u32).all(|step| {
            // Backwards from the end.
            let before = time * f64::from(step) / steps;
            let rate = self.rise - self.gravity * time;
            let rise = -rate * before - 0.5 * self.gravity * before * before;
            let place = seat - level * (self.walk * before) + self.up * rise;
            place.distance(seat) < UNTESTED_END * self.radius || self.is_free(place)
        })
    }
}
