//! Configurations of the sources' characters.

use clamber_climber::{ClimberConfig, GroundConfig};

/// Jolt's capsule: its radius of .3 and padding of .02 become a radius of .32, the distance at which our climber rests,
/// with a margin of .02.
pub(crate) fn jolt() -> ClimberConfig {
    let mut config = ClimberConfig::walker();
    config.body.radius = 0.32;
    config.body.height = 1.35;
    config.body.margin = 0.02;
    config.ground = GroundConfig {
        max_slope: radians(50.0),
        snap_distance: 0.5,
        step_height: 0.4,
        throw_acceleration: f64::INFINITY,
        ..config.ground
    };
    config
}

/// [`jolt`] with a walking speed.
pub(crate) fn walker_at(speed: f64) -> ClimberConfig {
    let mut config = jolt();
    config.ground.walk_speed = speed;
    config
}

/// A climber with every ability that never tires.
pub(crate) fn tireless() -> ClimberConfig {
    ClimberConfig {
        stamina: None,
        ..ClimberConfig::colossus_climber()
    }
}

pub(crate) fn radians(degrees: f64) -> f64 {
    degrees * core::f64::consts::PI / 180.0
}
