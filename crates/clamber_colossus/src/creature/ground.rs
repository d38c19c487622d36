//! The ground below a creature: its origin follows the ground, and its steps are shorter on steep ground.

use glam::DVec3;

use super::hips::{NEARS, approach};
use super::state::{GROUND, NO_GROUND};
use super::{Creature, Surroundings};
use crate::feet::Ground;

/// Distance between the places where the ground height is measured, as a share of the creature's height. Seven places
/// lie along the heading, from behind to ahead, and one to each side.
pub(super) const GROUND_SPACING: f64 = 0.07;

/// How much shorter steps are on slopes, uphill and downhill: by the factor 1 / (1 + `CAREFUL`) at 45 degrees.
const CAREFUL: f64 = 1.2;

/// Time constant of the steepness of the ground ahead, seconds for a creature of `GIANT` height.
const LOOKS_AHEAD: f64 = 1.0;

/// Largest vertical acceleration from following the ground, metres a second squared, unless `RUNS` allows more.
const CLIMBS: f64 = 0.5;

/// Largest vertical acceleration of a fast creature, as a share of the centripetal acceleration at its speed on a
/// circle whose radius is its height. With less, the creature would float above slopes or sink into them.
const RUNS: f64 = 0.4;

impl Creature {
    /// Length of the steps, as a share of their length in the clip.
    pub(super) fn stride(&self) -> f64 {
        1.0 / (1.0 + CAREFUL * self.state.steepness)
    }

    /// Lets the model's origin follow the ground below it, as gently as riders need it.
    pub(super) fn follow_ground(&mut self, around: &Surroundings<'_>, dt: f64) {
        let height = self.size.height;
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * height,
        };
        let heading = self.state.heading();
        let spacing = GROUND_SPACING * height;
        let aside = DVec3::new(heading.z, 0.0, -heading.x) * spacing;
        // One place in each tick; all of them in the first tick, and in a tick in which the creature moves by more than
        // the spacing.
        let is_first = self.state.ticks <= 1;
        let all = is_first || self.state.speed.abs() * dt > spacing;
        let turn = (self.state.ticks % GROUND as u64) as usize;
        for index in (0..GROUND).filter(|index| all || *index == turn) {
            let place = match index {
                7 => aside,
                8 => -aside,
                step => heading * ((step as f64 - 3.0) * spacing),
            };
            let level = ground.below(self.state.position + place);
            self.state.ground[index] = level.map_or(NO_GROUND, |(level, _)| level);
        }
        // The mean height over the length of a step or two: a ledge becomes a ramp.
        let known =
            |index: usize| Some(self.state.ground[index]).filter(|level| *level < NO_GROUND);
        let (mut sum, mut count, mut steepest) = (0.0, 0.0, 0f64);
        for index in 0..7 {
            let Some(level) = known(index) else { continue };
            (sum, count) = (sum + level, count + 1.0);
            if let Some(before) = index.checked_sub(1).filter(|_| index >= 3).and_then(known) {
                steepest = steepest.max((level - before).abs() / spacing);
            }
        }
        if count == 0.0 {
            return;
        }
        if let [Some(left), Some(right)] = [7, 8].map(known) {
            steepest = steepest.max((left - right).abs() / (2.0 * spacing));
        }
        // The steepness changes gradually, since the stride depends on it.
        let share = 1.0 - libm::exp(-dt / (LOOKS_AHEAD * self.size.pace.max(1e-3)));
        self.state.steepness += (steepest - self.state.steepness) * share;
        if is_first {
            // The creature was just placed.
            self.state.position.y = sum / count;
            self.state.steepness = steepest;
        }
        let speed = self.state.speed.abs();
        let most = CLIMBS.max(RUNS * speed * speed / height);
        let nears = NEARS.max(NEARS * speed / height);
        let now = [self.state.position.y, self.state.climb];
        let (height, climb) = approach(now, sum / count, [most, nears], dt);
        (self.state.position.y, self.state.climb) = (height, climb);
    }
}
