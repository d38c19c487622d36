use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// When a climber is knocked over, and how it tumbles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct TumbleConfig {
    /// Shake above which a standing climber is knocked down, metres a second squared, not negative. Default 30.
    /// Infinite: never.
    pub knock_acceleration: f64,
    /// Speed above which a blow knocks the climber down, or off a hold, metres a second, not negative, may be infinite.
    /// Default 3.
    pub knock_speed: f64,
    /// Speed of a landing, towards the ground or along it, above which the climber tumbles, metres a second, not
    /// negative, may be infinite. Default 11, a fall of six metres.
    pub landing_speed: f64,
    /// Coefficient of friction of a tumbling climber, not negative. Default 0.6.
    pub friction: f64,
    /// Coefficient of restitution: share of the impact speed at which the climber bounces back, 0 to 1. Default 0.2.
    pub restitution: f64,
    /// Time for which the climber has to lie still on ground that can be stood on before it gets up, seconds, not
    /// negative. Default 0.5.
    pub recover_time: f64,
}

impl TumbleConfig {
    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        knock_acceleration: 30.0,
        knock_speed: 3.0,
        landing_speed: 11.0,
        friction: 0.6,
        restitution: 0.2,
        recover_time: 0.5,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            knock_acceleration: self.knock_acceleration,
            knock_speed: self.knock_speed * scale.speed,
            landing_speed: self.landing_speed * scale.speed,
            friction: self.friction,
            restitution: self.restitution,
            recover_time: self.recover_time * scale.time,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::limit("tumble.knock_acceleration", self.knock_acceleration)?;
        check::limit("tumble.knock_speed", self.knock_speed)?;
        check::limit("tumble.landing_speed", self.landing_speed)?;
        check::not_negative("tumble.friction", self.friction)?;
        check::share("tumble.restitution", self.restitution)?;
        check::not_negative("tumble.recover_time", self.recover_time)
    }
}

/// Damage from falls and blows.
///
/// Hit points are 1 for an unhurt climber. A climber at 0 goes on as before: death is up to the game.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct HealthConfig {
    /// Largest speed of a landing that does no damage, metres a second towards the ground, not negative, may be
    /// infinite. Default 10, a fall of five metres.
    pub safe_speed: f64,
    /// Hit points that a landing costs for each metre a second by which it is faster than `safe_speed`, not negative.
    /// Default 0.05: a landing at 12 m/s takes an unhurt climber from 1 to 0.9. A blow costs its own
    /// [`Knockback::damage`](crate::Knockback::damage) instead.
    pub fall_damage: f64,
}

impl HealthConfig {
    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        safe_speed: 10.0,
        fall_damage: 0.05,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            safe_speed: self.safe_speed * scale.speed,
            fall_damage: self.fall_damage / scale.speed,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::limit("health.safe_speed", self.safe_speed)?;
        check::not_negative("health.fall_damage", self.fall_damage)
    }
}
