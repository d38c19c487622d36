use super::check;
use crate::ClimberError;

/// What holding on costs. Stamina is 1 when rested; at 0 the grip opens.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StaminaConfig {
    /// Spent on holding, a second, not negative. 1/40: forty seconds on a creature that keeps still.
    pub hold_drain: f64,
    /// Shake that costs nothing, metres a second squared, not negative. 4: a walk.
    pub shake_threshold: f64,
    /// Spent on what is beyond it, per metre a second, not negative. 1/60: a shake of 10 beyond it lasts six seconds.
    pub shake_drain: f64,
    /// Regained while standing on what does not shake, a second, not negative. 1/5.
    pub refill: f64,
}

impl StaminaConfig {
    pub(super) const DEFAULT: Self = Self {
        hold_drain: 1.0 / 40.0,
        shake_threshold: 4.0,
        shake_drain: 1.0 / 60.0,
        refill: 0.2,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("stamina.hold_drain", self.hold_drain)?;
        check::not_negative("stamina.shake_threshold", self.shake_threshold)?;
        check::not_negative("stamina.shake_drain", self.shake_drain)?;
        check::not_negative("stamina.refill", self.refill)
    }
}
