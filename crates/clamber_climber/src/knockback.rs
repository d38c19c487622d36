use clamber_world::ObstacleId;
use glam::DVec3;

use crate::ClimberError;

/// The effect of a blow on a climber. It takes place in the step that gets it in
/// [`StepRules::knockback`](crate::StepRules::knockback).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct Knockback {
    /// Change of the climber's velocity, in world space, metres a second.
    pub velocity: DVec3,
    /// Hit points that the blow costs, 0 to 1. Ignored without [`ClimberConfig::health`](crate::ClimberConfig::health).
    pub damage: f64,
    /// The obstacle that dealt the blow, if one did. Events repeat this id.
    pub by: Option<ObstacleId>,
}

impl Knockback {
    pub(crate) fn check(&self) -> Result<(), ClimberError> {
        if !self.velocity.is_finite() || !self.damage.is_finite() {
            return Err(ClimberError::NotFinite("knockback"));
        }
        if !(0.0..=1.0).contains(&self.damage) {
            return Err(ClimberError::OutOfRange {
                name: "knockback.damage",
                range: "from 0 to 1",
                found: self.damage,
            });
        }
        Ok(())
    }
}
