use clamber_world::Others;

use super::check;
use super::scale::Scale;
use crate::ClimberError;

/// Shape, mass and strength of a climber's body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct BodyConfig {
    /// Radius of the body's ball, metres, positive. The climber's position is the ball's centre. Default 0.4. Raise it
    /// to bridge rougher skin, lower it to reach into folds.
    pub radius: f64,
    /// Height of a second ball of the same radius above the first, centre to centre, metres, not negative. The body is
    /// the capsule around both balls while it stands, slides, falls, tumbles or is in a custom mode. It is the first
    /// ball alone while the climber grips, hangs or is asked to crouch
    /// ([`ClimberInput::crouch`](crate::ClimberInput::crouch)), and where there is no room to stand up. Default 0:
    /// always a ball.
    pub height: f64,
    /// Thickness of the body's outer layer, which may overlap obstacles, metres, from a thousandth to half of the
    /// radius. Default 0.01. The core inside this layer does not enter obstacles, unless the climber is crushed or the
    /// solver's rounds do not suffice ([`StepReport::is_clear`](crate::StepReport::is_clear)). A wider margin forgives
    /// rougher deformation and shows more overlap.
    pub margin: f64,
    /// Mass, kilograms, positive. Default 80. It determines the impulses on obstacles that can be pushed
    /// ([`Push`](crate::Push)).
    pub mass: f64,
    /// Largest force with which the climber pushes obstacles that it runs into, newtons, not negative. Default 600. It
    /// limits neither the climber's weight nor the impulse of an airborne climber.
    pub push_force: f64,
    /// Whether the climber blocks, pushes or passes another climber ([`ClimberObstacle`](crate::ClimberObstacle)) that
    /// it walks into. Default [`Others::Block`].
    pub others: Others,
}

/// Relative tolerance on the range of the margin: rounding, when radius and margin are scaled.
const ROUNDING: f64 = 1e-12;

impl BodyConfig {
    /// Defaults of the fields: a person's ball.
    pub(super) const BALL: Self = Self {
        radius: 0.4,
        height: 0.0,
        margin: 0.01,
        mass: 80.0,
        push_force: 600.0,
        others: Others::Block,
    };

    pub(super) fn scaled(self, scale: Scale) -> Self {
        Self {
            radius: self.radius * scale.length,
            height: self.height * scale.length,
            margin: self.margin * scale.length,
            mass: self.mass,
            push_force: self.push_force,
            others: self.others,
        }
    }

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::positive("body.radius", self.radius)?;
        check::not_negative("body.height", self.height)?;
        // A thinner margin would be less than the rounding error with which ground is found.
        let range = "from a thousandth to half of the radius";
        // With the tolerance, both ends stay in the range at every size.
        let (least, most) = (1e-3 * (1.0 - ROUNDING), 0.5 * (1.0 + ROUNDING));
        let holds = (self.radius * least..=self.radius * most).contains(&self.margin);
        check::check("body.margin", range, self.margin, holds)?;
        check::positive("body.mass", self.mass)?;
        check::not_negative("body.push_force", self.push_force)
    }
}
