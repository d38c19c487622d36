use super::check;
use crate::ClimberError;

/// A body that hangs by its hands: a pendulum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HangConfig {
    /// From the hands to the centre of its ball at full stretch, metres, positive. 0.9.
    pub arm_length: f64,
    /// From there to the end of the legs, which collide as well, metres, not negative. They are drawn in where there is
    /// no room for them, and come down in the tick after it begins to hang. 0.6.
    pub leg_length: f64,
    /// Of the swing, per second, not negative. 0.4: a third is left after three seconds.
    pub damping: f64,
}

impl HangConfig {
    pub(super) const DEFAULT: Self = Self {
        arm_length: 0.9,
        leg_length: 0.6,
        damping: 0.4,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::positive("hang.arm_length", self.arm_length)?;
        check::not_negative("hang.leg_length", self.leg_length)?;
        check::not_negative("hang.damping", self.damping)
    }
}
