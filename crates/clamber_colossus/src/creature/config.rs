use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::ColossusError;

/// Where a creature begins, and how large it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreatureConfig {
    /// Where its model's origin is at first: between its feet, on the ground, in world space.
    pub position: DVec3,
    /// Its heading at first, radians about Y; 0 is +Z, positive turns to its left.
    pub yaw: f64,
    /// How many times as large it is as its brain's file says ([`BodyFile::height`](crate::BodyFile::height)); metres per
    /// unit of its own file if that says nothing. 1 by default.
    pub scale: f64,
    /// The height for which its clips were made, metres, in place of
    /// [`BodyFile::made_for`](crate::BodyFile::made_for); `None` by default.
    pub made_for: Option<f64>,
    /// Seed of its lots; 0 by default.
    pub seed: u64,
    /// It does not walk further from where it began, metres; 100 by default.
    pub arena: f64,
    /// It does not walk onto steeper ground, radians; 25 degrees by default.
    pub most_slope: f64,
    /// It does not see further, metres; 150 by default.
    pub sight: f64,
    /// Noises that are no further away than this are heard as loud as they are, metres; 50 by default.
    pub hearing: f64,
}

impl Default for CreatureConfig {
    /// At the origin, of its file's size, with an arena of 100 m, slopes to 25 degrees, sight to 150 m and
    /// hearing to 50 m.
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

    /// Somebody who sets degrees reads what to set instead.
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
