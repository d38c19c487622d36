use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::ColossusError;

/// Start, size, seed and limits of a creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreatureConfig {
    /// Initial position of the model's origin, in world space, metres: between the feet, on the ground.
    pub position: DVec3,
    /// Initial heading, radians about Y. 0 is +Z; positive turns to the creature's left.
    pub yaw: f64,
    /// Factor on the size that the brain's file gives ([`BodyFile::height`](crate::BodyFile::height)); metres per unit
    /// of the creature's own file if the brain's file gives none. 1 by default.
    pub scale: f64,
    /// Height for which the clips were made, metres. It replaces [`BodyFile::made_for`](crate::BodyFile::made_for);
    /// `None` by default.
    pub made_for: Option<f64>,
    /// Seed of the creature's random numbers; 0 by default.
    pub seed: u64,
    /// Radius of the arena around the place where the creature began or was last put, metres; 100 by default. The
    /// creature walks out of it only if the game sends it.
    pub arena: f64,
    /// Steepest slope that the creature walks onto, radians; 25 degrees by default.
    pub most_slope: f64,
    /// Largest horizontal distance at which the creature sees a person, metres, from the model's origin to the middle
    /// of the person; 150 by default. It sees only people within 103 degrees of its heading to either side, and none
    /// behind terrain. People closer than half its width it notices wherever they are.
    pub sight: f64,
    /// Distance from the eye within which noises are heard at full loudness, metres; 50 by default. Farther away they
    /// are fainter ([`Noise::loudness`](crate::Noise::loudness)).
    pub hearing: f64,
}

impl Default for CreatureConfig {
    /// At the origin, with the size that the file gives, an arena of 100 m, slopes up to 25 degrees, sight up to 150 m
    /// and full hearing up to 50 m.
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            yaw: 0.0,
            scale: 1.0,
            made_for: None,
            seed: 0,
            arena: 100.0,
            most_slope: 25f64.to_radians(),
            sight: 150.0,
            hearing: 50.0,
        }
    }
}

impl CreatureConfig {
    pub(super) fn check(&self) -> Result<(), ColossusError> {
        let within = |what, range, found: f64, least: f64, most: f64| {
            if (least..=most).contains(&found) {
                Ok(())
            } else {
                Err(ColossusError::OutOfRange { what, range, found })
            }
        };
        for found in self.position.to_array() {
            within("position", "finite, and at most 1e12", found, -1e12, 1e12)?;
        }
        within("yaw", "at most 1,000,000, in radians", self.yaw, -1e6, 1e6)?;
        within("scale", "from 0.000001 to 1,000,000", self.scale, 1e-6, 1e6)?;
        if let Some(height) = self.made_for {
            within(
                "made_for",
                "from 0.001 to 100,000, in metres",
                height,
                1e-3,
                1e5,
            )?;
        }
        within("arena", "at least 0", self.arena, 0.0, f64::INFINITY)?;
        let most = core::f64::consts::FRAC_PI_2;
        within(
            "most_slope",
            "from 0 to 1.5708 (a quarter turn), in radians",
            self.most_slope,
            0.0,
            most,
        )?;
        within("sight", "at least 0", self.sight, 0.0, f64::INFINITY)?;
        within("hearing", "at least 0", self.hearing, 0.0, f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A caller that passes degrees by mistake finds the expected unit in the message.
    #[test]
    fn errors_about_angles_name_radians() {
        let steep = CreatureConfig {
            most_slope: 25.0,
            ..CreatureConfig::default()
        };
        let turned = CreatureConfig {
            yaw: f64::NAN,
            ..CreatureConfig::default()
        };
        for config in [steep, turned] {
            let text = config.check().unwrap_err().to_string();
            assert!(text.contains("radians"), "{text}");
        }
    }
}
