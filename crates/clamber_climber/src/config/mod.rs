//! What a climber is made of and how it moves, by topic.

mod body;
mod check;
mod grip;
mod ground;
mod hang;
mod harm;
mod ledge;
mod stamina;

pub use body::BodyConfig;
pub use grip::GripConfig;
pub use ground::GroundConfig;
pub use hang::HangConfig;
pub use harm::{HealthConfig, TumbleConfig};
pub use ledge::LedgeConfig;
pub use stamina::StaminaConfig;

use glam::DVec3;

use crate::ClimberError;

/// What a climber is made of and how it moves.
///
/// Begin with a preset, and change what differs. What is `None` is off, and costs nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClimberConfig {
    /// Metres a second squared; up is against it, any direction will do. 9.81 downwards along Y.
    pub gravity: DVec3,
    /// Over how many seconds a shake is felt, positive. 0.1. Longer forgives blows and tires less by fast trembling; at
    /// a tick or less it is noise.
    pub shake_time: f64,
    /// Shape and weight.
    pub body: BodyConfig,
    /// Standing, walking, jumping.
    pub ground: GroundConfig,
    /// Gripping fur and climbing on it.
    pub grip: Option<GripConfig>,
    /// Hanging from a grip that is too unstable to climb.
    pub hang: HangConfig,
    /// Hanging from ledges, and climbing over them.
    pub ledge: Option<LedgeConfig>,
    /// What holding on costs.
    pub stamina: Option<StaminaConfig>,
    /// Being knocked off one's feet.
    pub tumble: Option<TumbleConfig>,
    /// Being hurt.
    pub health: Option<HealthConfig>,
}

impl ClimberConfig {
    /// Stands, walks, jumps, slides and falls, and never tires: a character controller for level ground, slopes and
    /// platforms. The default.
    pub const fn walker() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.81, 0.0),
            shake_time: 0.1,
            body: BodyConfig::BALL,
            ground: GroundConfig::DEFAULT,
            grip: None,
            hang: HangConfig::DEFAULT,
            ledge: None,
            stamina: None,
            tumble: None,
            health: None,
        }
    }

    /// All that a climber can do, tuned for a person on a creature of 5 to 50 m.
    pub const fn colossus_climber() -> Self {
        Self {
            grip: Some(GripConfig::DEFAULT),
            ledge: Some(LedgeConfig::DEFAULT),
            stamina: Some(StaminaConfig::DEFAULT),
            tumble: Some(TumbleConfig::DEFAULT),
            health: Some(HealthConfig::DEFAULT),
            ..Self::walker()
        }
    }

    /// Against gravity; world Y where there is none.
    pub fn up(&self) -> DVec3 {
        (-self.gravity).normalize_or(DVec3::Y)
    }

    /// Angle of a unit vector from up, radians.
    pub(crate) fn slope(&self, normal: DVec3) -> f64 {
        clamber_mover::slope(normal, self.up())
    }

    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        if !self.gravity.is_finite() {
            return Err(ClimberError::NotFinite("gravity"));
        }
        check::positive("shake_time", self.shake_time)?;
        self.body.validate()?;
        self.ground.validate()?;
        self.hang.validate()?;
        self.grip.iter().try_for_each(GripConfig::validate)?;
        self.ledge.iter().try_for_each(LedgeConfig::validate)?;
        self.stamina.iter().try_for_each(StaminaConfig::validate)?;
        self.tumble.iter().try_for_each(TumbleConfig::validate)?;
        self.health.iter().try_for_each(HealthConfig::validate)
    }
}

impl Default for ClimberConfig {
    fn default() -> Self {
        Self::walker()
    }
}
