//! Feet on the ground: a planted foot stays where it came down, and a swinging foot goes to its landing place.
//!
//! A clip shows when a foot stands ([`Contacts`](crate::kind::Contacts)). While it does, the ball of the foot stays
//! where it came down. While the foot swings, its offset from the clip changes to the offset of the landing place, by a
//! cubic in time: this needs the least acceleration between given ends. If a foot stands elsewhere than in its clip, it
//! takes a step of its own. Thresholds of speed scale with the square root of the leg's length (Froude's law).

mod arrive;
mod foot;
mod goal;
mod ground;
mod sole;

pub(crate) use foot::{Foot, MOST_ASIDE_ACCELERATION, MOST_UP_ACCELERATION};
pub(crate) use goal::{FootGoal, GRAVITY, STEP_TIME, SWING_SHARES};
pub(crate) use ground::Ground;
pub(crate) use sole::{Footing, Sole};

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

/// How the ground below a creature has moved in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// Position of a point of the ground before the tick, in world space.
    pub(crate) from: DVec3,
    /// Position of this point after the tick, in world space.
    pub(crate) to: DVec3,
    /// Rotation of the ground in the tick.
    pub(crate) turn: DQuat,
    /// Yaw of this rotation, radians.
    pub(crate) yaw: f64,
}

impl Carried {
    /// New position of a place that moves with the ground.
    pub(crate) fn place(&self, place: DVec3) -> DVec3 {
        self.to + self.turn * (place - self.from)
    }

    /// The same with only the yaw of the ground, so that the place stays as high above the ground's point.
    pub(crate) fn level_place(&self, place: DVec3) -> DVec3 {
        self.to + self.vector(place - self.from)
    }

    /// Turns a vector of the creature by the yaw of the ground, so that upright vectors stay upright.
    pub(crate) fn vector(&self, vector: DVec3) -> DVec3 {
        rotation_from_axis_angle(DVec3::Y, self.yaw) * vector
    }
}
