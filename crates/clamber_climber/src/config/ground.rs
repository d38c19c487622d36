use super::check;
use crate::ClimberError;

/// Standing, walking, jumping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundConfig {
    /// Steepest slope to stand on, radians, below a right angle. 50 degrees. Who stands stays up to 2 degrees beyond it.
    pub max_slope: f64,
    /// Speed along the ground under full input, metres a second, not negative. 3.
    pub walk_speed: f64,
    /// Speed along up that a jump adds, metres a second, not negative. 5: 1.3 m high.
    pub jump_speed: f64,
    /// How far below it a walking climber still finds the ground, metres, not negative. 0.2: a step down, or how far a
    /// slope falls away in a tick. Raise it for coarse ground, lower it to fly off edges sooner.
    pub snap_distance: f64,
    /// Highest step that walking climbs, metres, not negative. 0.3.
    pub step_height: f64,
    /// For how long a jump still works after the ground has ended, seconds, not negative. 0.1.
    pub coyote_time: f64,
    /// For how long before it lands a jump is remembered, seconds, not negative. 0.15.
    pub jump_buffer: f64,
    /// How fast velocity along the ground comes to what is wanted, metres a second squared, not negative. 1,000: at once.
    /// Lower feels like ice, or heavy. Speed beyond `walk_speed` is braked by `friction` in its place.
    pub acceleration: f64,
    /// How fast speed along the ground beyond `walk_speed` is braked, metres a second squared, not negative: after a
    /// landing at speed, or a blow. 15.
    pub friction: f64,
    /// How fast input changes velocity in the air, metres a second squared, not negative. 0: it steers nothing. 10 is
    /// what platformers have.
    pub air_acceleration: f64,
    /// Gravity is multiplied by this while a jump still rises and its button is up, at least 1. 1: jumps have one height.
    /// 3 lets a tap jump a third as high.
    pub jump_release_gravity: f64,
    /// How hard the ground has to be pulled away to be lost, metres a second squared beyond gravity, as a shake is
    /// measured; not negative. 20. Infinite: feet stick to any ground. Lower is thrown sooner.
    pub throw_acceleration: f64,
}

impl GroundConfig {
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
        jump_release_gravity: 1.0,
        throw_acceleration: 20.0,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        let range = "from 0 to below a right angle";
        let right_angle = core::f64::consts::FRAC_PI_2;
        check::less_than("ground.max_slope", range, self.max_slope, right_angle)?;
        check::not_negative("ground.walk_speed", self.walk_speed)?;
        check::not_negative("ground.jump_speed", self.jump_speed)?;
        check::not_negative("ground.snap_distance", self.snap_distance)?;
        check::not_negative("ground.step_height", self.step_height)?;
        check::not_negative("ground.coyote_time", self.coyote_time)?;
        check::not_negative("ground.jump_buffer", self.jump_buffer)?;
        check::not_negative("ground.acceleration", self.acceleration)?;
        check::not_negative("ground.friction", self.friction)?;
        check::not_negative("ground.air_acceleration", self.air_acceleration)?;
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

/// Radians.
pub(super) const DEGREE: f64 = core::f64::consts::PI / 180.0;
