use glam::DVec3;

use crate::ClimberError;

/// What a climber is made of and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimberConfig {
    /// Radius of its sphere, metres. Default 0.4. Raise it to bridge rougher skin, lower it to
    /// reach into folds; push-outs between bending triangles grow with it.
    pub radius: f64,
    /// Steepest slope to stand on, radians, below a right angle. Default 50 degrees.
    pub max_slope: f64,
    /// Speed along the surface under full input, metres a second. Default 3.
    pub walk_speed: f64,
    /// Speed along up that a jump adds, metres a second. Default 5: 1.3 m high.
    pub jump_speed: f64,
    /// Metres a second squared; up is against it. Default 9.81 downwards along Y.
    pub gravity: DVec3,
    /// How far below its sphere a walking climber still finds the ground, metres. Default 0.2:
    /// a step, or how far a slope falls away in a tick. Raise it for coarse ground.
    pub snap_distance: f64,
}

impl Default for ClimberConfig {
    fn default() -> Self {
        Self {
            radius: 0.4,
            max_slope: 50.0_f64.to_radians(),
            walk_speed: 3.0,
            jump_speed: 5.0,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            snap_distance: 0.2,
        }
    }
}

impl ClimberConfig {
    /// Against gravity; world Y where there is none.
    pub fn up(&self) -> DVec3 {
        (-self.gravity).normalize_or(DVec3::Y)
    }

    /// Angle of a unit vector from up, radians.
    pub(crate) fn slope(&self, away: DVec3) -> f64 {
        libm::acos(away.dot(self.up()).clamp(-1.0, 1.0))
    }

    pub(crate) fn validate(&self) -> Result<(), ClimberError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let not_negative = |x: f64| x >= 0.0 && x.is_finite();
        let slope = not_negative(self.max_slope) && self.max_slope < core::f64::consts::FRAC_PI_2;
        let checks = [
            ("radius", "positive", self.radius, positive(self.radius)),
            (
                "max_slope",
                "from 0 to below a right angle",
                self.max_slope,
                slope,
            ),
            (
                "walk_speed",
                "not negative",
                self.walk_speed,
                not_negative(self.walk_speed),
            ),
            (
                "jump_speed",
                "not negative",
                self.jump_speed,
                not_negative(self.jump_speed),
            ),
            (
                "snap_distance",
                "not negative",
                self.snap_distance,
                not_negative(self.snap_distance),
            ),
        ];
        for (name, range, found, holds) in checks {
            if !holds {
                return Err(ClimberError::OutOfRange { name, range, found });
            }
        }
        if self.gravity.is_finite() {
            Ok(())
        } else {
            Err(ClimberError::NotFinite("gravity"))
        }
    }
}
