//! Arrows and stones: in flight, in the skin, and falling.

mod flight;
mod step;
mod stuck;

use clamber_world::{Attachment, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

pub use flight::Flight;
pub(crate) use step::{Air, Flown};
pub(crate) use stuck::place_on;

use crate::fighter::FighterId;

/// Number of a projectile: they are numbered in the order in which they are shot, and no number is used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ProjectileId(pub u64);

/// An arrow or a stone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projectile {
    /// Its number.
    pub id: ProjectileId,
    /// What it is.
    pub kind: ProjectileKind,
    /// Who shot or threw it, who may have left since.
    pub by: FighterId,
    /// What of it matters in flight.
    pub body: ProjectileBody,
    /// Seconds since it was shot, since it stuck, or since it has been falling.
    pub seconds: f64,
    /// How it moves.
    pub motion: ProjectileMotion,
}

/// What of a projectile matters in flight and when it hits. It keeps that of the bow or the stones of whoever shot it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectileBody {
    /// Radius, metres.
    pub radius: f64,
    /// Drag, 1/m: its air brakes an arrow by this times the square of its speed.
    pub drag: f64,
    /// How deep its tip goes into what it hits, metres.
    pub depth: f64,
    /// Damage at [`ProjectileBody::speed`]; it grows with the square of the speed relative to what is hit.
    pub damage: f64,
    /// Speed at which it does its damage, metres a second.
    pub speed: f64,
    /// How loud it is where it hits; 0 if nobody hears it.
    pub loudness: f64,
}

/// What a projectile is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ProjectileKind {
    /// An arrow: it sticks.
    Arrow,
    /// A stone: it is heard where it hits, and is gone then.
    Stone,
}

/// How a projectile moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum ProjectileMotion {
    /// Flies.
    Flying {
        /// Its tip, in world space.
        position: DVec3,
        /// Its velocity, metres a second.
        velocity: DVec3,
    },
    /// Sticks.
    Stuck {
        /// Where: the tip is the attachment's offset below the skin. Of creatures it is followed only when somebody
        /// asks ([`Arena::place`](crate::Arena::place)): its `point` and `frame` are those of the tick in which it
        /// stuck.
        at: Attachment,
        /// Where it points, in the frame of the material.
        direction: DVec3,
    },
    /// Falls, and hurts nobody: what it stuck in is gone, or there were too many.
    Falling {
        /// Its tip, in world space.
        position: DVec3,
        /// Its velocity, metres a second.
        velocity: DVec3,
        /// Where it points.
        direction: DVec3,
    },
}

/// Where a projectile is after a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectilePlace {
    /// Its tip, in world space.
    pub tip: DVec3,
    /// Where it points: a unit vector.
    pub direction: DVec3,
}

/// What sticks is no farther from the skin that it is in than this, metres.
const MOST_OFFSET: f64 = 1e9;

impl Projectile {
    /// True if it sticks.
    pub fn is_stuck(&self) -> bool {
        matches!(self.motion, ProjectileMotion::Stuck { .. })
    }

    /// True if it sticks in an obstacle.
    pub(crate) fn is_in(&self, obstacle: ObstacleId) -> bool {
        matches!(self.motion, ProjectileMotion::Stuck { at, .. } if at.obstacle == obstacle)
    }

    /// True if it still flies.
    pub fn is_flying(&self) -> bool {
        matches!(self.motion, ProjectileMotion::Flying { .. })
    }

    pub(crate) fn is_finite(&self) -> bool {
        let motion = match &self.motion {
            ProjectileMotion::Flying { position, velocity } => {
                position.is_finite() && velocity.is_finite()
            }
            ProjectileMotion::Stuck { at, direction } => {
                let is_near = at.offset.abs().max_element() <= MOST_OFFSET;
                at.is_finite() && is_near && direction.is_finite()
            }
            ProjectileMotion::Falling {
                position,
                velocity,
                direction,
            } => position.is_finite() && velocity.is_finite() && direction.is_finite(),
        };
        let ProjectileBody {
            radius,
            drag,
            depth,
            damage,
            speed,
            loudness,
        } = self.body;
        let numbers = [self.seconds, radius, drag, depth, damage, speed, loudness];
        motion && numbers.iter().all(|x| (0.0..=f64::MAX).contains(x))
    }
}
