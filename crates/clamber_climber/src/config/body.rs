use super::check;
use crate::ClimberError;

/// Shape and weight of a climber.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyConfig {
    /// Of its ball, metres, positive; its position is the ball's centre. 0.4. Raise it to bridge rougher skin, lower it
    /// to reach into folds.
    pub radius: f64,
    /// How far a second ball of the same radius stands above, metres; the body is the capsule around both while it
    /// stands, slides or falls, and the ball alone while it crouches on a hold. 0: always the ball.
    pub height: f64,
    /// Outer layer of the ball and capsule that may overlap what it touches, metres, less than the radius. 0.01. The core
    /// below it enters nothing. Wider forgives rougher deformation, and shows more overlap.
    pub margin: f64,
    /// Kilograms, positive. 80. What it stands on and runs into feels it, if it can be pushed.
    pub mass: f64,
    /// With what it pushes what it runs into at most, newtons, not negative. 600. Its weight, and what it strikes in the
    /// air, are not limited by it.
    pub push_force: f64,
}

impl BodyConfig {
    pub(super) const BALL: Self = Self {
        radius: 0.4,
        height: 0.0,
        margin: 0.01,
        mass: 80.0,
        push_force: 600.0,
    };

    pub(super) fn validate(&self) -> Result<(), ClimberError> {
        check::positive("body.radius", self.radius)?;
        check::not_negative("body.height", self.height)?;
        let range = "not negative and less than the radius";
        check::less_than("body.margin", range, self.margin, self.radius)?;
        check::positive("body.mass", self.mass)?;
        check::not_negative("body.push_force", self.push_force)
    }
}
