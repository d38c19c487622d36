use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// Settings for hanging from ledges and climbing over them: [`ClimberConfig::ledge`](crate::ClimberConfig::ledge).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct LedgeConfig {
    /// Greatest height of a ledge above the ball's centre, metres, not negative. Default 0.9. A climber that stands on
    /// level ground reaches ledges up to radius + `reach_up` above the ground, and with a jump up to its height more,
    /// `jump_speed`² / (2 · gravity). [`BodyConfig::height`](crate::BodyConfig::height) does not count: for a taller
    /// body, raise `reach_up`, `drop` and [`HangConfig::arm_length`](crate::HangConfig::arm_length) as well.
    pub reach_up: f64,
    /// Greatest distance of the wall in front from the ball, and width of a gap in a ledge that hands reach across,
    /// metres, not negative. Default 0.35.
    pub reach: f64,
    /// Distance of the climber's position, the centre of the body's ball, below the ledge from which it hangs, metres,
    /// not negative. Default 0.6.
    pub drop: f64,
    /// Speed along a ledge, metres a second, not negative. Default 1. At 0 the climber does not move along ledges.
    pub shimmy_speed: f64,
    /// Duration of a pull-up, seconds, positive. Default 0.6.
    pub pull_up_time: f64,
    /// Largest speed relative to a ledge at which hands catch it in flight, metres a second, not negative, may be
    /// infinite. Default 15. See [`GripConfig::catch_speed`](crate::GripConfig::catch_speed).
    pub catch_speed: f64,
}

impl LedgeConfig {
    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        reach_up: 0.9,
        reach: 0.35,
        drop: 0.6,
        shimmy_speed: 1.0,
        pull_up_time: 0.6,
        catch_speed: 15.0,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            reach_up: self.reach_up * scale.length,
            reach: self.reach * scale.length,
            drop: self.drop * scale.length,
            shimmy_speed: self.shimmy_speed * scale.speed,
            pull_up_time: self.pull_up_time * scale.time,
            catch_speed: self.catch_speed * scale.speed,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::not_negative("ledge.reach_up", self.reach_up)?;
        check::not_negative("ledge.reach", self.reach)?;
        check::not_negative("ledge.drop", self.drop)?;
        check::not_negative("ledge.shimmy_speed", self.shimmy_speed)?;
        check::positive("ledge.pull_up_time", self.pull_up_time)?;
        check::limit("ledge.catch_speed", self.catch_speed)
    }
}
