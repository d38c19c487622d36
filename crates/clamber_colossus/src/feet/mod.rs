//! Feet on the ground: planted where they came down, and put where the ground will be.
//!
//! A clip shows when a foot stands ([`Contacts`](crate::kind::Contacts)). While it does, its ball stays where it came
//! down; while it swings, the difference to the clip goes to that of the place where it will land, by a cubic in time,
//! which takes the least acceleration for given ends. When the clip stands elsewhere than the foot, it takes a step of
//! its own. Speeds that decide scale with the square root of the leg's length (Froude's law).

mod arrive;
mod foot;
mod ground;
mod sole;

pub(crate) use foot::{Foot, FootGoal, GRAVITY, MOST_ASIDE, MOST_UP, SHARES, STEP_TIME};
pub(crate) use ground::Ground;
pub(crate) use sole::{Footing, Sole};

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

/// How ground below a creature has moved in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// Where a point of it was, and is now.
    pub(crate) from: DVec3,
    pub(crate) to: DVec3,
    /// How it has turned, and how far about up, radians.
    pub(crate) turn: DQuat,
    pub(crate) yaw: f64,
}

impl Carried {
    /// Where a place is that goes with the ground.
    pub(crate) fn place(&self, place: DVec3) -> DVec3 {
        self.to + self.turn * (place - self.from)
    }

    /// The same for a place that stays as high above the ground: it turns about up alone.
    pub(crate) fn level_place(&self, place: DVec3) -> DVec3 {
        self.to + self.vector(place - self.from)
    }

    /// A vector of the creature, turned with its heading: what stands upright stays so.
    pub(crate) fn vector(&self, vector: DVec3) -> DVec3 {
        rotation_from_axis_angle(DVec3::Y, self.yaw) * vector
    }
}
