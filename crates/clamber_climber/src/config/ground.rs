use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// Settings for standing, walking and jumping: [`ClimberConfig::ground`](crate::ClimberConfig::ground).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct GroundConfig {
    /// Steepest slope to stand on, radians from level, from one degree to below a right angle. Default 50 degrees,
    /// 0.873. A climber that stands already stays on slopes up to 2 degrees steeper.
    pub max_slope: f64,
    /// Speed along the ground under full input, metres a second, not negative. Default 3.
    pub walk_speed: f64,
    /// Upward speed that a jump adds, metres a second, not negative. Default 5, which jumps 1.3 m high.
    pub jump_speed: f64,
    /// Distance below its feet in which a walking climber looks for ground to stay on, metres, not negative. Default
    /// 0.2. It has to cover a step down, and the distance by which a slope falls away in a tick. Raise it for coarse
    /// ground, lower it to fly off edges sooner.
    pub snap_distance: f64,
    /// Highest step that walking climbs, metres, not negative. Default 0.3.
    pub step_height: f64,
    /// Time after the ground has ended in which a jump still works, seconds, not negative. Default 0.1.
    pub coyote_time: f64,
    /// Time for which a jump that came too early is remembered, seconds, not negative. Default 0.15.
    pub jump_buffer: f64,
    /// Acceleration along the ground towards the velocity that the input asks for, metres a second squared, not
    /// negative. Default 1,000: practically at once. Lower values feel like ice, or heavy. Speed above `walk_speed` is
    /// braked by `friction` instead.
    pub acceleration: f64,
    /// Deceleration along the ground, metres a second squared, not negative. Default 15. It applies while the climber
    /// is faster than `walk_speed`, for example after a fast landing, or slides from a blow.
    pub friction: f64,
    /// Acceleration by input in the air, metres a second squared, not negative. Default 0: no steering. Platformers
    /// have about 10.
    pub air_acceleration: f64,
    /// Largest speed of a fall relative to the air, along gravity, metres a second, positive, may be infinite. Default
    /// 60, the terminal speed of a person. A body that is thrown down faster is slowed by as much as gravity would
    /// speed it up.
    pub terminal_speed: f64,
    /// Coefficient of friction on slopes that are too steep to stand on, not negative. Default 0. However large it is,
    /// a body keeps sliding down slopes that it cannot stand on.
    pub slide_friction: f64,
    /// Factor on gravity while a jump still rises and [`jump_held`](crate::ClimberInput::jump_held) is false, at least
    /// 1 and finite. Default 1: every jump is equally high. At 3 a tap jumps a third as high.
    pub jump_release_gravity: f64,
    /// Threshold at which the ground throws the climber off: the amount by which the ground's acceleration away from
    /// the feet exceeds gravity, metres a second squared, not negative. Default 20: under a gravity of 9.81, level
    /// ground has to accelerate downwards at more than 29.81. Both accelerations are taken along the ground's normal,
    /// and the ground's acceleration is low-pass filtered ([`ClimberState::shake`](crate::ClimberState::shake)). Lower
    /// values throw sooner; at infinity, feet stick to any ground.
    pub throw_acceleration: f64,
}

/// Angle by which the slope under a standing climber may be steeper than the slopes on which it lands, radians: 2
/// degrees. It is more than the wobble of a breathing animal, so that the mode does not flicker.
const SLOPE_HYSTERESIS: f64 = 0.035;

impl GroundConfig {
    /// Steepest slope that a climber which stands already stays on, radians from level.
    pub fn release_slope(&self) -> f64 {
        self.max_slope + SLOPE_HYSTERESIS
    }

    /// Defaults of the fields: a person's.
    pub(super) const DEFAULT: Self = Self {
        max_slope: 50.0 * DEGREE,
        walk_speed: 3.0,
        jump_speed: 5.0,
        snap_distance: 0.2,
        step_height: 0.3,
        coyote_time: 0.1,
        jump_buffer: 0.15,
        acceleration: 1_000.0,
        friction: 15.0,
        air_acceleration: 0.0,
        terminal_speed: 60.0,
        slide_friction: 0.0,
        jump_release_gravity: 1.0,
        throw_acceleration: 20.0,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            max_slope: self.max_slope,
            walk_speed: self.walk_speed * scale.speed,
            jump_speed: self.jump_speed * scale.speed,
            snap_distance: self.snap_distance * scale.length,
            step_height: self.step_height * scale.length,
            coyote_time: self.coyote_time * scale.time,
            jump_buffer: self.jump_buffer * scale.time,
            acceleration: self.acceleration,
            friction: self.friction,
            air_acceleration: self.air_acceleration,
            terminal_speed: self.terminal_speed * scale.speed,
            slide_friction: self.slide_friction,
            jump_release_gravity: self.jump_release_gravity,
            throw_acceleration: self.throw_acceleration,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        // At least one degree, since the normals of level skin are rounded.
        let range = "in radians, from 0.0175 (one degree) to below 1.5708 (a right angle)";
        let right_angle = core::f64::consts::FRAC_PI_2;
        let holds = (DEGREE..right_angle).contains(&self.max_slope);
        check::check("ground.max_slope", range, self.max_slope, holds)?;
        check::not_negative("ground.walk_speed", self.walk_speed)?;
        check::not_negative("ground.jump_speed", self.jump_speed)?;
        check::not_negative("ground.snap_distance", self.snap_distance)?;
        check::not_negative("ground.step_height", self.step_height)?;
        check::not_negative("ground.coyote_time", self.coyote_time)?;
        check::not_negative("ground.jump_buffer", self.jump_buffer)?;
        check::not_negative("ground.acceleration", self.acceleration)?;
        check::not_negative("ground.friction", self.friction)?;
        check::not_negative("ground.air_acceleration", self.air_acceleration)?;
        let terminal = self.terminal_speed;
        check::check(
            "ground.terminal_speed",
            "positive",
            terminal,
            terminal > 0.0,
        )?;
        check::not_negative("ground.slide_friction", self.slide_friction)?;
        let gravity = self.jump_release_gravity;
        let name = "ground.jump_release_gravity";
        check::check(
            name,
            "at least 1 and finite",
            gravity,
            gravity >= 1.0 && gravity.is_finite(),
        )?;
        check::limit("ground.throw_acceleration", self.throw_acceleration)
    }
}

/// One degree in radians.
pub(super) const DEGREE: f64 = core::f64::consts::PI / 180.0;
