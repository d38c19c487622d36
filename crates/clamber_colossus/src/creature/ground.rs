//! The ground below a creature: its origin follows the ground, and its steps are shorter on steep ground.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::hips::{APPROACH_RATE, approach};
use super::state::{is_far, is_fast, is_large};
use super::{Creature, Surroundings};
use crate::feet::{Carried, Ground};

/// Distance between the places where the ground height is measured, as a share of the creature's height. Seven places
/// lie along the heading, from behind to ahead, and one to each side.
const GROUND_SPACING: f64 = 0.07;

/// How much shorter steps are on slopes, uphill and downhill: by the factor 1 / (1 + `SLOPE_SHORTENING`) at 45 degrees.
const SLOPE_SHORTENING: f64 = 1.2;

/// Time constant of the steepness of the ground ahead, seconds for a creature of `GIANT_HEIGHT`.
const STEEPNESS_TIME: f64 = 1.0;

/// Largest vertical acceleration from following the ground, metres a second squared, unless
/// `CLIMB_SHARE_OF_CENTRIPETAL` allows more.
const MAX_CLIMB_ACCELERATION: f64 = 0.5;

/// Largest vertical acceleration of a fast creature, as a share of the centripetal acceleration at its speed on a
/// circle whose radius is its height. With less, the creature would float above slopes or sink into them.
const CLIMB_SHARE_OF_CENTRIPETAL: f64 = 0.4;

/// Height that stands for no ground below, because JSON has no infinity.
pub(super) const NO_GROUND: f64 = f64::MAX;

/// Number of places where the ground height is measured.
const GROUND_PLACES: usize = 9;

/// Index of the place to the left. The places before it lie along the heading, from behind to ahead.
const LEFT_PLACE: usize = 7;

/// Index of the place to the right.
const RIGHT_PLACE: usize = 8;

/// Where a creature is, and the ground around it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct OnGround {
    /// Position of the model's origin, in world space. Its height follows the ground.
    position: DVec3,
    /// Vertical velocity of the origin from following the ground, metres a second.
    climb: f64,
    /// Heights of the ground: along the heading, from behind to ahead, then to the left and to the right. Each tick
    /// measures one of them.
    heights: [f64; GROUND_PLACES],
}

/// The ground along the heading: its mean height, and its largest slope, ahead or across.
struct Profile {
    height: f64,
    /// Tangent of the slope.
    steepest: f64,
}

impl OnGround {
    /// At a place, with unknown ground.
    pub(super) fn at(position: DVec3) -> Self {
        Self {
            position,
            climb: 0.0,
            heights: [NO_GROUND; GROUND_PLACES],
        }
    }

    pub(super) fn position(&self) -> DVec3 {
        self.position
    }

    /// Moves the origin.
    pub(super) fn advance(&mut self, way: DVec3) {
        self.position += way;
    }

    /// Moves the origin with the ground, and the stored heights by `rise`.
    pub(super) fn be_carried(&mut self, carried: &Carried, rise: f64) {
        self.position = carried.place(self.position);
        for level in &mut self.heights {
            if *level < NO_GROUND {
                *level += rise;
            }
        }
    }

    /// Rise of the ground along the heading and to the left, each as a tangent between `-most` and `most`, for a
    /// creature of a height in metres.
    pub(super) fn slopes(&self, height: f64, most: f64) -> [f64; 2] {
        let rise = |[from, to]: [usize; 2], steps: f64| {
            let [from, to] = [from, to].map(|index| self.heights[index]);
            let known = from < NO_GROUND && to < NO_GROUND;
            let rise = (to - from) / (steps * GROUND_SPACING * height);
            if known { rise.clamp(-most, most) } else { 0.0 }
        };
        [rise([0, 6], 6.0), rise([RIGHT_PLACE, LEFT_PLACE], 2.0)]
    }

    /// The profile of the ground; `None` without ground. The mean height over the length of a step or two makes a ramp
    /// of a ledge.
    fn profile(&self, spacing: f64) -> Option<Profile> {
        let known = |index: usize| Some(self.heights[index]).filter(|level| *level < NO_GROUND);
        let (mut sum, mut count, mut steepest) = (0.0, 0.0, 0f64);
        for index in 0..LEFT_PLACE {
            let Some(level) = known(index) else { continue };
            (sum, count) = (sum + level, count + 1.0);
            if let Some(before) = index.checked_sub(1).filter(|_| index >= 3).and_then(known) {
                steepest = steepest.max((level - before).abs() / spacing);
            }
        }
        if count == 0.0 {
            return None;
        }
        if let [Some(left), Some(right)] = [LEFT_PLACE, RIGHT_PLACE].map(known) {
            steepest = steepest.max((left - right).abs() / (2.0 * spacing));
        }
        Some(Profile {
            height: sum / count,
            steepest,
        })
    }

    /// True if all numbers are in the range that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        let mut levels = self.heights.iter();
        !is_far(self.position)
            && !is_fast(self.climb)
            && levels.all(|level| *level == NO_GROUND || !is_large(*level))
    }
}

impl Creature {
    /// Length of the steps, as a share of their length in the clip.
    pub(super) fn stride(&self) -> f64 {
        1.0 / (1.0 + SLOPE_SHORTENING * self.state.motion.steepness())
    }

    /// Lets the model's origin follow the ground below it, as gently as riders need it.
    pub(super) fn follow_ground(&mut self, around: &Surroundings<'_>, dt: f64) {
        let height = self.size.height;
        let spacing = GROUND_SPACING * height;
        let is_first = self.state.clock.is_first();
        self.measure_ground(around, spacing, dt);
        let Some(profile) = self.state.on_ground.profile(spacing) else {
            return;
        };
        let speed = self.state.speed().abs();
        let (on_ground, motion) = (&mut self.state.on_ground, &mut self.state.motion);
        if is_first {
            // The creature was just placed.
            on_ground.position.y = profile.height;
            motion.set_steepness(profile.steepest);
        } else {
            // The steepness changes gradually, since the stride depends on it.
            let share = 1.0 - libm::exp(-dt / (STEEPNESS_TIME * self.size.pace.max(1e-3)));
            motion.set_steepness(
                motion.steepness() + (profile.steepest - motion.steepness()) * share,
            );
        }
        let most = MAX_CLIMB_ACCELERATION.max(CLIMB_SHARE_OF_CENTRIPETAL * speed * speed / height);
        let nears = APPROACH_RATE.max(APPROACH_RATE * speed / height);
        let now = [on_ground.position.y, on_ground.climb];
        (on_ground.position.y, on_ground.climb) = approach(now, profile.height, [most, nears], dt);
    }

    /// Measures the height of the ground at one place in each tick; at all of them in the first tick, and in a tick in
    /// which the creature moves by more than their spacing.
    fn measure_ground(&mut self, around: &Surroundings<'_>, spacing: f64, dt: f64) {
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * self.size.height,
        };
        let heading = self.state.heading();
        let aside = DVec3::new(heading.z, 0.0, -heading.x) * spacing;
        let all = self.state.clock.is_first() || self.state.speed().abs() * dt > spacing;
        let turn = (self.state.ticks() % GROUND_PLACES as u64) as usize;
        for index in (0..GROUND_PLACES).filter(|index| all || *index == turn) {
            let place = match index {
                LEFT_PLACE => aside,
                RIGHT_PLACE => -aside,
                step => heading * ((step as f64 - 3.0) * spacing),
            };
            let on_ground = &mut self.state.on_ground;
            let level = ground.below(on_ground.position + place);
            on_ground.heights[index] = level.map_or(NO_GROUND, |(level, _)| level);
        }
    }
}
