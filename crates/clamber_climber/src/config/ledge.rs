use super::check;
use crate::ClimberError;

/// Hanging from ledges, and climbing over them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LedgeConfig {
    /// How far above its centre a ledge may be to be caught, metres, not negative. 0.9.
    pub reach_up: f64,
    /// How far beyond its ball, metres, not negative. 0.35.
    pub reach: f64,
    /// How far below the ledge its centre hangs, metres, not negative. 0.6.
    pub drop: f64,
    /// Speed along a ledge, metres a second, not negative. 1.
    pub shimmy_speed: f64,
    /// How long pulling up takes, seconds, positive. 0.6.
    pub pull_up_time: f64,
}

impl LedgeConfig {
    pub(super) const DEFAULT: Self = Self {
        reach_up: 0.9,
        reach: 0.35,
        drop: 0.6,
        shimmy_speed: 1.0,
        pull_up_time: 0.6,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("ledge.reach_up", self.reach_up)?;
        check::not_negative("ledge.reach", self.reach)?;
        check::not_negative("ledge.drop", self.drop)?;
        check::not_negative("ledge.shimmy_speed", self.shimmy_speed)?;
        check::positive("ledge.pull_up_time", self.pull_up_time)
    }
}
