use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// Costs of holding on, in stamina. Stamina is 1 for a rested climber; at 0 its grip opens.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct StaminaConfig {
    /// Stamina spent per second of holding on, not negative. Default 1/40: forty seconds on a creature that keeps
    /// still.
    pub hold_drain: f64,
    /// Shake up to which holding on costs no extra stamina, metres a second squared, not negative. Default 4, the shake
    /// of a walk.
    pub shake_threshold: f64,
    /// Stamina spent per second and per m/s² of shake above the threshold, not negative. Default 1/60: a shake of 10
    /// m/s² above the threshold uses up a rested climber's stamina in six seconds, not counting `hold_drain`.
    pub shake_drain: f64,
    /// Stamina regained per second while the climber stands on ground whose shake is not above the threshold, not
    /// negative. Default 1/5.
    pub refill: f64,
    /// Stamina spent by a jump off a hold or a ledge, 0 to 1. Default 0.03: a jump gains less height than climbing for
    /// as much. A climber with less stamina does not jump.
    pub jump_cost: f64,
    /// Stamina spent by catching a hold or a ledge in flight, for each metre a second by which the speed relative to it
    /// exceeds the walking speed, not negative. Default 1/400. A climber whose stamina does not suffice slips.
    pub catch_cost: f64,
    /// Stamina spent by a pull-up over a ledge, 0 to 1. Default 0.01.
    pub mantle_cost: f64,
}

impl StaminaConfig {
    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        hold_drain: 1.0 / 40.0,
        shake_threshold: 4.0,
        shake_drain: 1.0 / 60.0,
        refill: 0.2,
        jump_cost: 0.03,
        catch_cost: 1.0 / 400.0,
        mantle_cost: 0.01,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            hold_drain: self.hold_drain / scale.time,
            shake_threshold: self.shake_threshold,
            shake_drain: self.shake_drain / scale.time,
            refill: self.refill / scale.time,
            jump_cost: self.jump_cost,
            catch_cost: self.catch_cost / scale.speed,
            mantle_cost: self.mantle_cost,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("stamina.hold_drain", self.hold_drain)?;
        check::not_negative("stamina.shake_threshold", self.shake_threshold)?;
        check::not_negative("stamina.shake_drain", self.shake_drain)?;
        check::not_negative("stamina.refill", self.refill)?;
        check::share("stamina.jump_cost", self.jump_cost)?;
        check::not_negative("stamina.catch_cost", self.catch_cost)?;
        check::share("stamina.mantle_cost", self.mantle_cost)
    }
}
