use super::check;
use super::ground::DEGREE;
use crate::ClimberError;

/// Gripping what can be gripped, and climbing on it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GripConfig {
    /// How far beyond its ball it grips, metres, not negative. 0.35: an arm. Raise it to grab more easily in flight.
    pub reach: f64,
    /// Speed along what is gripped, metres a second, not negative. 1.5.
    pub climb_speed: f64,
    /// How far what is gripped may lean over, radians from level ground, beyond which it hangs. 180 degrees: it climbs
    /// along ceilings. 120 hangs from all that leans over by 30.
    pub max_overhang: f64,
    /// Shake from which it only hangs, metres a second squared, not negative. 15. Below seven tenths of it for
    /// `calm_time` it climbs again.
    pub hang_acceleration: f64,
    /// Seconds, not negative. 0.4.
    pub calm_time: f64,
    /// Speed at which a jump leaves a hold, away from it and upwards, metres a second, not negative. 4.
    pub jump_speed: f64,
}

impl GripConfig {
    pub(super) const DEFAULT: Self = Self {
        reach: 0.35,
        climb_speed: 1.5,
        max_overhang: 180.0 * DEGREE,
        hang_acceleration: 15.0,
        calm_time: 0.4,
        jump_speed: 4.0,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("grip.reach", self.reach)?;
        check::not_negative("grip.climb_speed", self.climb_speed)?;
        check::not_negative("grip.max_overhang", self.max_overhang)?;
        check::limit("grip.hang_acceleration", self.hang_acceleration)?;
        check::not_negative("grip.calm_time", self.calm_time)?;
        check::not_negative("grip.jump_speed", self.jump_speed)
    }
}
