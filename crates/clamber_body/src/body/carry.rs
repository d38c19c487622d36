//! The rigid motion of a climber's support: all that a body remembers in world space moves with it.

use clamber_world::{Attachment, Obstacle, ObstacleId};
use glam::{DQuat, DVec3};

use crate::figure::Place;

/// A rigid motion since the last frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carry {
    from: DVec3,
    to: DVec3,
    turn: DQuat,
}

impl Carry {
    /// The motion of a material point; `None` if the material is gone.
    pub(crate) fn by(
        carrier: &Attachment,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) -> Option<Self> {
        let (_, obstacle) = obstacles.iter().find(|(id, _)| *id == carrier.obstacle)?;
        let mut now = *carrier;
        now.follow(*obstacle, dt.max(f64::MIN_POSITIVE), FOLLOW_SLACK)?;
        Some(Self {
            from: carrier.point,
            to: now.point,
            turn: (now.frame * carrier.frame.conjugate()).normalize(),
        })
    }

    /// A translation.
    pub(crate) fn along(way: DVec3) -> Self {
        Self {
            from: DVec3::ZERO,
            to: way,
            turn: DQuat::IDENTITY,
        }
    }

    pub(crate) fn point(&self, point: DVec3) -> DVec3 {
        self.to + self.turn * (point - self.from)
    }

    pub(crate) fn vector(&self, vector: DVec3) -> DVec3 {
        self.turn * vector
    }

    pub(crate) fn rotation(&self, rotation: DQuat) -> DQuat {
        (self.turn * rotation).normalize()
    }

    pub(crate) fn place(&self, place: &Place) -> Place {
        Place {
            position: self.point(place.position),
            rotation: self.rotation(place.rotation),
        }
    }
}

/// Largest distance between a stored material point and the obstacle's report of its previous position, metres; see
/// [`Attachment::follow`]. A larger distance ends the hold.
pub(crate) const FOLLOW_SLACK: f64 = 0.05;
