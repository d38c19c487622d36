use super::check;
use crate::ClimberError;

/// Being knocked off one's feet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TumbleConfig {
    /// Shake that knocks down who stands, metres a second squared, not negative. 30. Infinite: none does.
    pub knock_acceleration: f64,
    /// Blow that knocks down, or off a hold, metres a second, not negative. 3.
    pub knock_speed: f64,
    /// Speed of a landing that ends on the back, metres a second, not negative. 11: a fall of six metres.
    pub landing_speed: f64,
    /// Coefficient of friction of who lies and slides, not negative. 0.6.
    pub friction: f64,
    /// Share of the speed that it bounces back with, 0 to 1. 0.2.
    pub restitution: f64,
    /// For how long it has to lie still on what can be stood on before it gets up, seconds, not negative. 0.5.
    pub recover_time: f64,
}

impl TumbleConfig {
    pub(super) const DEFAULT: Self = Self {
        knock_acceleration: 30.0,
        knock_speed: 3.0,
        landing_speed: 11.0,
        friction: 0.6,
        restitution: 0.2,
        recover_time: 0.5,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::limit("tumble.knock_acceleration", self.knock_acceleration)?;
        check::limit("tumble.knock_speed", self.knock_speed)?;
        check::limit("tumble.landing_speed", self.landing_speed)?;
        check::not_negative("tumble.friction", self.friction)?;
        check::share("tumble.restitution", self.restitution)?;
        check::not_negative("tumble.recover_time", self.recover_time)
    }
}

/// Being hurt. Hit points are 1 when whole; at 0 the climber is as good as dead, which is the game's to act on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HealthConfig {
    /// Fastest landing that does not hurt, metres a second, not negative. 10: a fall of five metres.
    pub safe_speed: f64,
    /// Hit points that each metre a second beyond it costs, not negative. 0.05.
    pub fall_damage: f64,
}

impl HealthConfig {
    pub(super) const DEFAULT: Self = Self {
        safe_speed: 10.0,
        fall_damage: 0.05,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::limit("health.safe_speed", self.safe_speed)?;
        check::not_negative("health.fall_damage", self.fall_damage)
    }
}
