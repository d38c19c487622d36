//! Where a climber gets on from the ground.

use clamber_climber::ClimberConfig;
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::Patch;
use crate::GraphConfig;
use crate::survey::Survey;

/// A place where a climber gets on from the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub struct Entry {
    /// The patch.
    pub patch: usize,
    /// How high the middle of the climber's ball is there, metres above the ground.
    pub height: f64,
    /// How fast a climber that jumps from the ground, at the speed of a walk, passes what its hands reach there, at
    /// most, metres a second. 0 where it reaches that from the ground, without a jump.
    pub speed: f64,
}

/// Patches that a climber on the ground gets to with a jump: straight up, to where its hands reach, or forwards at the
/// speed of a walk. A jump forwards is tried in this many directions.
const DIRECTIONS: u32 = 16;

/// The patches to which a jump leads through free space.
pub(super) fn entries(survey: &Survey, patches: &[Patch], patch_of: &[u32]) -> Vec<Entry> {
    let jumps = Jumps::new(survey);
    let highest = highest_entry(&survey.config);
    let mut lowest = vec![f64::INFINITY; patches.len()];
    for (piece, patch) in survey.pieces.iter().zip(patch_of) {
        let (Some(seat), Some(lowest)) = (piece.seat, lowest.get_mut(*patch as usize)) else {
            continue;
        };
        let height = seat.dot(jumps.up) - survey.ground;
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
    /// True if a jump passes it so slowly that hands catch it.
    pub(super) fn is_caught(&self, climber: &ClimberConfig) -> bool {
        climber
            .grip
            .is_some_and(|grip| self.speed <= grip.catch_speed)
    }
}

/// The greatest speed of a jump from the ground where hands reach a place, which is that high above the ground: at the
/// lowest point from where they reach it.
fn speed_at(config: &GraphConfig, height: f64) -> f64 {
    let rises = height - config.radius() - config.reach().max(0.0);
    if rises <= 0.0 {
        return 0.0;
    }
    let (climber, ground) = (&config.climber, &config.climber.ground);
    let squared = ground.jump_speed * ground.jump_speed - 2.0 * climber.gravity.length() * rises;
    libm::hypot(libm::sqrt(squared.max(0.0)), ground.walk_speed)
}

/// How high the middle of a climber's ball may be for its hands to reach something with a jump from the ground, metres.
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

/// Steps of a ball on its way, as a share of its radius.
const STEP: f64 = 0.5;

/// A ball on its way may be so deep in skin, as a share of its radius: seats have as much.
const TOUCH: f64 = 0.03;

/// A jump does not lead onto skin that is nearer to its end than this, as a share of the radius: there it touches
/// already.
const ARRIVES: f64 = 0.5;

/// Jumps from the ground.
struct Jumps<'a> {
    surface: &'a SkinnedSurface,
    up: DVec3,
    ground: f64,
    radius: f64,
    /// Speeds at the take-off, metres a second, and gravity, metres a second squared.
    rise: f64,
    walk: f64,
    gravity: f64,
}

impl<'a> Jumps<'a> {
    fn new(survey: &'a Survey) -> Self {
        let climber = &survey.config.climber;
        Self {
            surface: &survey.surface,
            up: climber.up(),
            ground: survey.ground,
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
            .closest_point(place, self.radius * (1.0 - TOUCH));
        hit.is_none()
    }

    fn is_free_below(&self, seat: DVec3) -> bool {
        let way = seat.dot(self.up) - self.ground - self.radius;
        let steps = (way / (STEP * self.radius)).ceil().max(1.0);
        (1..=steps as u32)
            .all(|step| self.is_free(seat - self.up * (way * f64::from(step) / steps)))
    }

    /// True if a jump at the speed of a walk leads to a seat, on its way up or down.
    fn lead_forwards_to(&self, seat: DVec3) -> bool {
        let height = seat.dot(self.up) - self.ground - self.radius;
        let under = self.rise * self.rise - 2.0 * self.gravity * height;
        if self.gravity <= 0.0 || under < 0.0 {
            return false;
        }
        let ahead = self.up.any_orthonormal_vector();
        let aside = self.up.cross(ahead);
        let times = [-1.0, 1.0].map(|sign| (self.rise + sign * libm::sqrt(under)) / self.gravity);
        (0..DIRECTIONS).any(|k| {
            let angle = core::f64::consts::TAU * f64::from(k) / f64::from(DIRECTIONS);
            let level = ahead * libm::cos(angle) + aside * libm::sin(angle);
            let jump = |time: &f64| *time > 0.0 && self.is_arc_free(seat, level, *time);
            times.iter().any(jump)
        })
    }

    /// True if nothing is in the way of a jump that comes to a seat after some seconds.
    fn is_arc_free(&self, seat: DVec3, level: DVec3, time: f64) -> bool {
        let fastest = self.rise.max(self.rise - self.gravity * time) + self.walk;
        let steps = (fastest * time / (STEP * self.radius)).ceil().max(1.0);
        (1..=steps as u32).all(|step| {
            // Backwards from its end.
            let before = time * f64::from(step) / steps;
            let rate = self.rise - self.gravity * time;
            let rise = -rate * before - 0.5 * self.gravity * before * before;
            let place = seat - level * (self.walk * before) + self.up * rise;
            place.distance(seat) < ARRIVES * self.radius || self.is_free(place)
        })
    }
}
