use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// Settings for hanging by the hands from a grip, as a pendulum: [`ClimberConfig::hang`](crate::ClimberConfig::hang).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct HangConfig {
    /// Distance from the hands to the centre of the ball at full stretch, metres, positive. Default 0.9.
    pub arm_length: f64,
    /// Distance from the centre of the ball to the centre of an equal ball at the end of the legs, metres, not
    /// negative. Default 0.6. Legs collide, from the second tick of hanging on. They are drawn in where there is no
    /// room for them.
    pub leg_length: f64,
    /// Damping rate of the swing's velocity, per second, not negative. Default 0.4: about a third of the swing's energy
    /// is left after three seconds.
    pub damping: f64,
}

impl HangConfig {
    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        arm_length: 0.9,
        leg_length: 0.6,
        damping: 0.4,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            arm_length: self.arm_length * scale.length,
            leg_length: self.leg_length * scale.length,
            damping: self.damping / scale.time,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::positive("hang.arm_length", self.arm_length)?;
        check::not_negative("hang.leg_length", self.leg_length)?;
        check::not_negative("hang.damping", self.damping)
    }
}
