//! A climber's configuration, by topic.

mod body;
mod check;
mod grip;
mod ground;
mod hang;
mod harm;
mod ledge;
mod scale;
mod stamina;

pub use body::BodyConfig;
pub use clamber_world::{Others, OthersError};
pub use grip::GripConfig;
pub use ground::GroundConfig;
pub use hang::HangConfig;
pub use harm::{HealthConfig, TumbleConfig};
pub use ledge::LedgeConfig;
pub use stamina::StaminaConfig;

use glam::DVec3;

use crate::ClimberError;
use scale::Scale;

/// A climber's body and abilities.
///
/// Start from a preset, [`ClimberConfig::walker`] or [`ClimberConfig::colossus_climber`], and change fields. For a
/// character of another size, start from [`ClimberConfig::scaled`]. An ability that is `None` is off, and costs
/// nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
// A group with a misspelt name would be an ability that is off.
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct ClimberConfig {
    /// Gravity in world space, metres a second squared. Any direction and size; up is opposite to it, or +Y if it is
    /// zero. Default 9.81 along -Y.
    pub gravity: DVec3,
    /// Time constant of the low-pass filter that measures shake, seconds, positive. Default 0.1. A longer time forgives
    /// jolts, and makes fast trembling cost less stamina. At the length of a tick or less, the measured shake is noise.
    pub shake_time: f64,
    /// Shape, mass and strength.
    pub body: BodyConfig,
    /// Standing, walking and jumping.
    pub ground: GroundConfig,
    /// Gripping and climbing.
    pub grip: Option<GripConfig>,
    /// Hanging from a grip that shakes or leans over too far to climb on.
    pub hang: HangConfig,
    /// Hanging from ledges and climbing over them.
    pub ledge: Option<LedgeConfig>,
    /// How much stamina holding on costs.
    pub stamina: Option<StaminaConfig>,
    /// Being knocked over, and tumbling.
    pub tumble: Option<TumbleConfig>,
    /// Damage from falls and blows.
    pub health: Option<HealthConfig>,
}

impl ClimberConfig {
    /// A character controller for level ground, slopes and platforms: stands, walks, jumps, slides and falls; does
    /// not grip, and never tires. The default.
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

    /// Every ability on, tuned for a person on a creature of 5 to 50 m.
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

    /// The same character `size` times as large, under the same gravity: a mouse, an imp, an ogre. Its movements look
    /// alike, but take √`size` times as long (Froude's law).
    ///
    /// | numbers | factor |
    /// |---|---|
    /// | lengths | `size` |
    /// | speeds, times | √`size` |
    /// | rates per second (also those of stamina and damping), costs and damage for each m/s | 1 / √`size` |
    /// | gravity, other accelerations, mass, force, angles, coefficients, shares, costs of one effort | 1 |
    ///
    /// Mass and force are left to you: a body of the same density has `size`³ times both. Constants that are not part
    /// of the configuration do not change with the size: a climber that let go grips nothing for 0.3 s, and arms draw
    /// it into place below a ledge at 7.5 radii a second.
    ///
    /// `size` must be positive and finite. `scaled` does not check it: for any other size, it returns a configuration
    /// that [`Climber::new`](crate::Climber::new), [`set_config`](crate::Climber::set_config) and
    /// [`try_resize`](crate::Climber::try_resize) refuse. Their
    /// [`ClimberError::OutOfRange`](crate::ClimberError::OutOfRange) names `shake_time`, which they check first.
    ///
    /// ```
    /// use clamber_climber::ClimberConfig;
    ///
    /// let imp = ClimberConfig::colossus_climber().scaled(0.25);
    /// assert_eq!(imp.body.radius, 0.1); // metres
    /// assert_eq!(imp.ground.walk_speed, 1.5); // metres a second
    /// ```
    #[must_use]
    pub fn scaled(self, size: f64) -> Self {
        let scale = Scale::of_size(size);
        Self {
            gravity: self.gravity,
            shake_time: self.shake_time * scale.time,
            body: self.body.scaled(scale),
            ground: self.ground.scaled(scale),
            grip: self.grip.map(|grip| grip.scaled(scale)),
            hang: self.hang.scaled(scale),
            ledge: self.ledge.map(|ledge| ledge.scaled(scale)),
            stamina: self.stamina.map(|stamina| stamina.scaled(scale)),
            tumble: self.tumble.map(|tumble| tumble.scaled(scale)),
            health: self.health.map(|health| health.scaled(scale)),
        }
    }

    /// Unit vector opposite to gravity; world +Y if gravity is zero.
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
