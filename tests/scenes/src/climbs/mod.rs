//! A climber on a creature that moves.
//!
//! A route from [`Ways::climb`] leads along the edges of the skin, from a foot to the head, for a climber that does not
//! plan.

mod route;
mod stage;

pub use route::Ways;
pub use stage::{Motion, Stage};

use clamber_climber::ClimberConfig;

/// Ticks per second along a route.
pub const RATE: f64 = 60.0;

/// The settings of a climber for long ways: [`ClimberConfig::colossus_climber`], with stamina to hold on for 600 s to a
/// creature that keeps still.
pub fn long_climber() -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    if let Some(stamina) = &mut config.stamina {
        stamina.hold_drain = 1.0 / 600.0;
    }
    config
}
