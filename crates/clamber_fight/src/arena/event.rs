use clamber_climber::ClimberEvent;
use clamber_colossus::CreatureEvent;
use clamber_world::{MaterialPoint, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::CreatureId;
use crate::fighter::FighterId;
use crate::projectile::ProjectileId;

/// How a fighter struck.
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

/// An event of an arena's step.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ArenaEvent {
    /// An event of a creature.
    Creature {
        /// The creature.
        creature: CreatureId,
        /// The creature's own event.
        event: CreatureEvent,
    },
    /// An event of a fighter's climber.
    Climber {
        /// The fighter.
        fighter: FighterId,
        /// The climber's own event.
        event: ClimberEvent,
    },
    /// A weapon struck a creature.
    Hit {
        /// The fighter that struck.
        by: FighterId,
        /// How it struck.
        weapon: Weapon,
        /// The arrow or stone; `None` for a cut or a stab.
        projectile: Option<ProjectileId>,
        /// The creature that was struck.
        creature: CreatureId,
        /// The point of the creature's skin that was struck.
        at: MaterialPoint,
        /// Position of the struck point `at` at the time of the hit, in world space, metres.
        place: DVec3,
        /// Time of the hit within the tick: 0 is the tick's beginning, 1 its end.
        time: f64,
        /// Index in [`CreatureKind::weak_points`](clamber_colossus::CreatureKind::weak_points) of the open weak point
        /// there; `None` without one.
        weak_point: Option<usize>,
        /// Index in [`CreatureKind::plates`](clamber_colossus::CreatureKind::plates) of the unbroken plate that took
        /// the hit, so that no weak point below it is hurt; `None` without one.
        plate: Option<usize>,
        /// Damage done to the weak point: at most the hit points that it had left, and 0 if the hit hurt no weak point.
        /// The creature reports the effect in the next step: [`CreatureEvent::Hurt`], [`CreatureEvent::Staggered`].
        ///
        /// [`CreatureEvent::Hurt`]: clamber_colossus::CreatureEvent::Hurt
        /// [`CreatureEvent::Staggered`]: clamber_colossus::CreatureEvent::Staggered
        damage: f64,
    },
    /// A creature struck a fighter. The blow reaches the fighter in the next step.
    Struck {
        /// The creature that struck.
        creature: CreatureId,
        /// The fighter that was struck.
        fighter: FighterId,
        /// Change of the fighter's velocity, in world space, metres a second.
        velocity: DVec3,
        /// Hit points that the blow costs, 0 to 1.
        damage: f64,
        /// Point where the blow met the fighter, in world space, metres.
        place: DVec3,
    },
    /// An arrow was shot or a stone was thrown.
    Shot {
        /// The fighter that shot or threw it.
        by: FighterId,
        /// The projectile.
        projectile: ProjectileId,
    },
    /// An arrow got stuck.
    Stuck {
        /// The arrow.
        projectile: ProjectileId,
        /// The obstacle that it sticks in.
        obstacle: ObstacleId,
        /// Position of the hit at its time, in world space, metres.
        place: DVec3,
    },
    /// A stuck arrow falls: the skin or terrain that it stuck in is gone, or too many arrows stick.
    CameLoose {
        /// The arrow.
        projectile: ProjectileId,
    },
    /// A shake, a blow or the loss of its hold broke off a fighter's act.
    BrokenOff {
        /// The fighter.
        fighter: FighterId,
    },
    /// A fighter died.
    Died {
        /// The fighter.
        fighter: FighterId,
    },
    /// A dead fighter lives again, at its spawn point or the free place nearest to it.
    Rose {
        /// The fighter.
        fighter: FighterId,
    },
    /// A creature was killed.
    Killed {
        /// The creature.
        creature: CreatureId,
        /// The fighter whose hit killed it; `None` if an order did.
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
    /// An order named a fighter, creature or projectile that is not there. It changed nothing.
    Unheard {
        /// Index of the order in this step's list.
        order: usize,
    },
}
