use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::{ArenaError, positive, within};

/// Settings that all creatures, fighters and projectiles of an arena share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArenaConfig {
    /// Length of a tick, seconds; 1/60 by default. Brains have to be made for the same tick.
    pub tick: f64,
    /// Gravity of the fighters' arrows and stones, in world space, metres a second squared; 9.81 along -Y by default.
    /// Climbers have their own ([`ClimberConfig::gravity`](clamber_climber::ClimberConfig::gravity)), and so have the
    /// shots of creatures ([`Shot::gravity`](clamber_colossus::brain::Shot::gravity)).
    pub gravity: DVec3,
    /// Direction to the sun, in world space, of any length; 45 degrees above +Z by default. It matters only for
    /// [`Arena::sword_light`](crate::Arena::sword_light), the rays of light from a fighter's sword that lead to a weak
    /// point: they show only while neither terrain nor a creature shades the sword's tip. Zero is no sun, and no rays.
    pub sun: DVec3,
    /// Greatest number of arrows that stick at the same time; 500 by default. When there are more, the oldest fall.
    pub stuck_arrows: u32,
    /// A fighter below this height dies, since it has fallen out of the world. World Y, metres; -10,000 by default.
    pub floor: f64,
    /// Seed of the fighters' random streams. Creatures have seeds of their own.
    pub seed: u64,
}

impl Default for ArenaConfig {
    /// 60 ticks a second, Earth's gravity, 500 arrows.
    fn default() -> Self {
        Self {
            tick: 1.0 / 60.0,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            sun: DVec3::new(0.0, 1.0, 1.0),
            stuck_arrows: 500,
            floor: -1e4,
            seed: 0,
        }
    }
}

impl ArenaConfig {
    pub(super) fn check(&self) -> Result<(), ArenaError> {
        positive("tick", self.tick)?;
        for x in self.gravity.to_array() {
            within("gravity", "finite", x, [f64::MIN, f64::MAX])?;
        }
        for x in self.sun.to_array() {
            within("sun", "finite", x, [f64::MIN, f64::MAX])?;
        }
        within("floor", "finite", self.floor, [f64::MIN, f64::MAX])
    }
}
