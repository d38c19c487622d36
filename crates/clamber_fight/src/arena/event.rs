use clamber_climber::ClimberEvent;
use clamber_colossus::CreatureEvent;
use clamber_world::{MaterialPoint, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::CreatureId;
use crate::fighter::FighterId;
use crate::projectile::ProjectileId;

/// What somebody struck with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Weapon {
    /// A cut of the sword.
    Cut,
    /// A stab of the sword.
    Stab,
    /// An arrow.
    Arrow,
    /// A stone.
    Stone,
}

/// Something that happened in a step of an arena.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArenaEvent {
    /// Something happened to a creature, or it did something.
    Creature {
        /// The creature.
        creature: CreatureId,
        /// What happened.
        event: CreatureEvent,
    },
    /// Something happened to a fighter's climber.
    Climber {
        /// The fighter.
        fighter: FighterId,
        /// What happened.
        event: ClimberEvent,
    },
    /// A weapon struck a creature.
    Hit {
        /// Who struck.
        by: FighterId,
        /// With what.
        weapon: Weapon,
        /// The arrow or the stone, if it was one.
        projectile: Option<ProjectileId>,
        /// Whom.
        creature: CreatureId,
        /// The point of the creature's skin.
        at: MaterialPoint,
        /// Where that is, in world space, at the time of the hit.
        place: DVec3,
        /// Share of the tick.
        time: f64,
        /// The open weak point there, by its index.
        weak_point: Option<usize>,
        /// The whole plate that took the hit, by its index: weak points below it are not hurt.
        plate: Option<usize>,
        /// Damage done to a weak point: less than the weapon could do if the point had less left, 0 elsewhere. The
        /// creature tells in the next step what became of it: [`CreatureEvent::Hurt`], [`CreatureEvent::Staggered`].
        ///
        /// [`CreatureEvent::Hurt`]: clamber_colossus::CreatureEvent::Hurt
        /// [`CreatureEvent::Staggered`]: clamber_colossus::CreatureEvent::Staggered
        damage: f64,
    },
    /// A creature struck a fighter, who feels it in the next step.
    Struck {
        /// Who struck.
        creature: CreatureId,
        /// Whom.
        fighter: FighterId,
        /// Change of the fighter's velocity, metres a second.
        velocity: DVec3,
        /// Hit points, 0 to 1.
        damage: f64,
        /// Where, in world space.
        place: DVec3,
    },
    /// An arrow was shot or a stone was thrown.
    Shot {
        /// Who shot it.
        by: FighterId,
        /// The projectile.
        projectile: ProjectileId,
    },
    /// An arrow sticks.
    Stuck {
        /// The arrow.
        projectile: ProjectileId,
        /// What it sticks in.
        obstacle: ObstacleId,
        /// Where, in world space, at the time of the hit.
        place: DVec3,
    },
    /// An arrow that stuck falls: what it stuck in is gone, or there were too many.
    CameLoose {
        /// The arrow.
        projectile: ProjectileId,
    },
    /// What a fighter did with its weapons was broken off: by a shake, a blow, or the loss of its hold.
    BrokenOff {
        /// The fighter.
        fighter: FighterId,
    },
    /// A fighter died.
    Died {
        /// The fighter.
        fighter: FighterId,
    },
    /// A fighter stands where it began, and lives again.
    Rose {
        /// The fighter.
        fighter: FighterId,
    },
    /// A creature was killed.
    Killed {
        /// The creature.
        creature: CreatureId,
        /// Whose hit it was; `None` if it was an order's.
        by: Option<FighterId>,
    },
    /// A creature has joined.
    CreatureJoined {
        /// The creature.
        creature: CreatureId,
    },
    /// A creature has left.
    CreatureLeft {
        /// The creature.
        creature: CreatureId,
    },
    /// A fighter has joined.
    FighterJoined {
        /// The fighter.
        fighter: FighterId,
    },
    /// A fighter has left.
    FighterLeft {
        /// The fighter.
        fighter: FighterId,
    },
    /// An order was for somebody who is not there, and changed nothing.
    Unheard {
        /// Its index in the list of this step's orders.
        order: usize,
    },
}
