//! Arrows and stones: in flight, stuck, and falling.

mod ballistics;
mod step;
mod stuck;

use clamber_world::{Attachment, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

pub use ballistics::Ballistics;
pub(crate) use step::{Air, Flown};
pub(crate) use stuck::place_on;

use crate::fighter::FighterId;

/// Number of a projectile. Projectiles are numbered in the order in which they are shot, and no number is used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ProjectileId(pub u64);

/// An arrow or a stone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Projectile {
    /// The projectile's number.
    pub id: ProjectileId,
    /// Arrow or stone.
    pub kind: ProjectileKind,
    /// The fighter that shot or threw it; it may have left since.
    pub by: FighterId,
    /// Its radius, drag, damage and other properties, which stay the same from the shot on.
    pub body: ProjectileBody,
    /// Seconds since it was shot, got stuck, or came loose, whichever was last.
    pub seconds: f64,
    /// Whether it flies, sticks in something, or falls after it came loose. To draw it, take its place from
    /// [`Arena::place`](crate::Arena::place): what is stored here of a stuck arrow does not follow a creature's skin.
    pub motion: ProjectileMotion,
}

/// A projectile's properties in flight and at a hit. They are copied from the bow or the stones when it is shot, so
/// they stay when its fighter leaves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProjectileBody {
    /// Radius of the ball that touches obstacles, metres: an arrow's tip, or a stone.
    pub radius: f64,
    /// Drag, 1/m: the deceleration is this times the square of the speed.
    pub drag: f64,
    /// How deep its tip goes into the obstacle that it hits, metres.
    pub depth: f64,
    /// Damage of a hit at [`ProjectileBody::speed`], in the unit of weak points' hit points; 0 for a stone. It is
    /// proportional to the square of the speed relative to the struck point of the skin, which may move, and has no
    /// upper limit.
    pub damage: f64,
    /// Speed relative to the struck point of the skin at which it does exactly [`ProjectileBody::damage`], metres a
    /// second. At another speed the damage is multiplied by the square of the ratio.
    pub speed: f64,
    /// Loudness of its impact, which creatures hear ([`Noise`](clamber_colossus::Noise)), in units of the game; 0 for
    /// silent.
    pub loudness: f64,
}

/// Whether a projectile is an arrow or a stone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ProjectileKind {
    /// An arrow, which sticks in the obstacle that it hits.
    Arrow,
    /// A stone. Creatures hear its impact; it is removed then.
    Stone,
}

/// Where a projectile is and how it moves after the last tick. It flies first. An arrow then sticks in what it hits. An
/// arrow that comes loose falls, until it is removed. [`Arena::place`](crate::Arena::place) gives the position and
/// direction in all three cases.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum ProjectileMotion {
    /// The projectile flies.
    Flying {
        /// The tip of the arrow, or the middle of the stone, in world space, metres.
        position: DVec3,
        /// Its velocity in world space, metres a second.
        velocity: DVec3,
    },
    /// The arrow sticks in a creature or in terrain, and moves with it.
    Stuck {
        /// Attachment to the material; the tip is at its offset, below the surface. On creatures the attachment does
        /// not follow the skin: its `point` and `frame` are from the tick in which the arrow got stuck, and
        /// [`Arena::place`](crate::Arena::place) computes the current position.
        at: Attachment,
        /// Direction in which it points, in the frame of the material; a unit vector.
        direction: DVec3,
    },
    /// An arrow that came loose falls, and does no damage: its material is gone, or too many arrows stick.
    Falling {
        /// The arrow's tip, in world space, metres.
        position: DVec3,
        /// The arrow's velocity in world space, metres a second.
        velocity: DVec3,
        /// Direction in which it points, in world space; a unit vector.
        direction: DVec3,
    },
}

/// Position and direction of a projectile in world space, for drawing it after a step:
/// [`Arena::place`](crate::Arena::place) gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectilePlace {
    /// The tip of an arrow, or the middle of a stone, in world space, metres.
    pub tip: DVec3,
    /// Direction in which it points, in world space; a unit vector. While the projectile flies it is the direction of
    /// its velocity, or -Y without any; afterwards that from the arrow's rear end to its tip. A stone has no other
    /// state than flight.
    pub direction: DVec3,
}

/// Largest coordinate of a stuck arrow's offset from the skin, metres. A saved state beyond it is refused.
const MOST_OFFSET: f64 = 1e9;

impl Projectile {
    /// True if it sticks in a creature or in terrain.
    pub fn is_stuck(&self) -> bool {
        matches!(self.motion, ProjectileMotion::Stuck { .. })
    }

    /// True if it sticks in an obstacle.
    pub(crate) fn is_in(&self, obstacle: ObstacleId) -> bool {
        matches!(self.motion, ProjectileMotion::Stuck { at, .. } if at.obstacle == obstacle)
    }

    /// True if it has been in flight since it was shot or thrown. False once it sticks, and while it falls after
    /// it came loose.
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
