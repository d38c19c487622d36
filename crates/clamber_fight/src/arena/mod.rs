//! The arena: all that fights, stepped in one order.

mod aimed;
mod assets;
mod config;
mod event;
mod file;
mod fingerprint;
mod light;
mod outcome;
mod state;
mod step;

use clamber_colossus::{Creature, CreatureConfig, CreatureKind};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

pub use aimed::Aimed;
pub use config::ArenaConfig;
pub use event::{ArenaEvent, Weapon};
pub use light::SwordLight;
pub(crate) use outcome::{Hit, Outcome};
pub use state::ArenaState;

use crate::error::ArenaError;
use crate::fighter::{Fighter, FighterConfig, FighterId};
use crate::projectile::{Projectile, ProjectileId, ProjectileMotion, ProjectilePlace, place_on};

/// A creature of an arena, by its number: they are numbered in the order in which they are added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct CreatureId(pub u32);

/// Where the obstacle ids of creatures and of fighters begin. Terrain has smaller ones, such as the bits of an engine's
/// entities.
const CREATURES: u64 = 1 << 62;
const FIGHTERS: u64 = 1 << 63;

/// The obstacle id of a creature: climbers' states and contacts name it.
pub const fn creature_obstacle(creature: CreatureId) -> ObstacleId {
    ObstacleId(CREATURES + creature.0 as u64)
}

/// The obstacle id of a fighter, to the other fighters.
pub const fn fighter_obstacle(fighter: FighterId) -> ObstacleId {
    ObstacleId(FIGHTERS + fighter.0 as u64)
}

/// The index of the creature with an obstacle id; `None` for terrain and fighters.
pub(crate) fn creature_index(obstacle: ObstacleId) -> Option<usize> {
    let index = obstacle.0.checked_sub(CREATURES)?;
    (index < FIGHTERS - CREATURES).then_some(index as usize)
}

/// All that fights: creatures, fighters, projectiles, and their random streams, as one value that is stepped by a list
/// of inputs.
///
/// Terrain is the game's: it is passed to each step, and is not part of what is saved. Terrain that moves has to be
/// where it was when a step is repeated.
#[derive(Clone, Debug)]
pub struct Arena {
    config: ArenaConfig,
    creatures: Vec<Creature>,
    fighters: Vec<Fighter>,
    /// By ascending number.
    projectiles: Vec<Projectile>,
    next_projectile: u64,
    noises: Vec<clamber_colossus::Noise>,
    tick: u64,
    events: Vec<ArenaEvent>,
    /// Hash of all that does not change.
    assets: u64,
    scratch: step::Scratch,
}

impl Arena {
    /// An arena without anybody in it.
    ///
    /// # Errors
    /// [`ArenaError::OutOfRange`] for a configuration outside its ranges.
    pub fn new(config: ArenaConfig) -> Result<Self, ArenaError> {
        config.check()?;
        Ok(Self {
            assets: assets::of_arena(&config),
            config,
            creatures: Vec::new(),
            fighters: Vec::new(),
            projectiles: Vec::new(),
            next_projectile: 0,
            noises: Vec::new(),
            tick: 0,
            events: Vec::new(),
            scratch: step::Scratch::default(),
        })
    }

    /// Adds a creature. Do it before the first step, or in the same tick everywhere: states that were saved before are
    /// of another arena.
    ///
    /// # Errors
    /// [`ArenaError::Tick`] if its brain was made for another tick, and [`ArenaError::Creature`] as of [`Creature::new`].
    pub fn add_creature(
        &mut self,
        kind: Arc<CreatureKind>,
        config: CreatureConfig,
    ) -> Result<CreatureId, ArenaError> {
        let (creature, arena) = (kind.brain().tick(), self.config.tick);
        if creature != arena {
            return Err(ArenaError::Tick { creature, arena });
        }
        let assets = assets::with_creature(self.assets, &kind, &config);
        self.creatures.push(Creature::new(kind, config)?);
        self.assets = assets;
        Ok(CreatureId(self.creatures.len() as u32 - 1))
    }

    /// Adds a fighter, at rest in the air; `position` is the centre of its climber's ball. It comes back there after
    /// its death. Do it before the first step, or in the same tick everywhere: states that were saved before are of
    /// another arena.
    ///
    /// # Errors
    /// [`ArenaError::OutOfRange`] and [`ArenaError::Climber`] for a configuration outside its ranges, or a position that is not
    /// finite.
    pub fn add_fighter(
        &mut self,
        config: FighterConfig,
        position: DVec3,
    ) -> Result<FighterId, ArenaError> {
        let id = FighterId(self.fighters.len() as u32);
        let seed = self
            .config
            .seed
            .wrapping_add(u64::from(id.0).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let fighter = Fighter::new(id, config, position, seed)?;
        self.assets = assets::with_fighter(self.assets, &config, position);
        self.fighters.push(fighter);
        Ok(id)
    }

    /// The configuration.
    pub fn config(&self) -> &ArenaConfig {
        &self.config
    }

    /// Ticks so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The creatures, by number.
    pub fn creatures(&self) -> &[Creature] {
        &self.creatures
    }

    /// A creature; `None` if there is no such creature.
    pub fn creature(&self, id: CreatureId) -> Option<&Creature> {
        self.creatures.get(id.0 as usize)
    }

    /// A creature, to set its own senses. What else is changed in it is not saved.
    pub fn creature_mut(&mut self, id: CreatureId) -> Option<&mut Creature> {
        self.creatures.get_mut(id.0 as usize)
    }

    /// The fighters, by number.
    pub fn fighters(&self) -> &[Fighter] {
        &self.fighters
    }

    /// A fighter; `None` if there is no such fighter.
    pub fn fighter(&self, id: FighterId) -> Option<&Fighter> {
        self.fighters.get(id.0 as usize)
    }

    /// Arrows and stones, by ascending number.
    pub fn projectiles(&self) -> &[Projectile] {
        &self.projectiles
    }

    /// What happened in the last step, in order.
    pub fn events(&self) -> &[ArenaEvent] {
        &self.events
    }

    /// Where a projectile is after the last step; `None` if what it sticks in is gone, or its terrain was not passed.
    pub fn place(
        &self,
        projectile: &Projectile,
        terrain: &[(ObstacleId, &dyn Obstacle)],
    ) -> Option<ProjectilePlace> {
        match &projectile.motion {
            ProjectileMotion::Flying { position, velocity } => Some(ProjectilePlace {
                tip: *position,
                direction: velocity.normalize_or(DVec3::NEG_Y),
            }),
            ProjectileMotion::Falling {
                position,
                direction,
                ..
            } => Some(ProjectilePlace {
                tip: *position,
                direction: *direction,
            }),
            ProjectileMotion::Stuck { at, direction } => match creature_index(at.obstacle) {
                Some(index) => place_on(at, *direction, self.creatures.get(index)?.surface()),
                None => {
                    let (_, obstacle) = terrain.iter().find(|(id, _)| *id == at.obstacle)?;
                    place_on(at, *direction, *obstacle)
                }
            },
        }
    }

    /// A projectile by its number; `None` if it is gone.
    pub fn projectile(&self, id: ProjectileId) -> Option<&Projectile> {
        let found = self
            .projectiles
            .binary_search_by_key(&id, |one| one.id)
            .ok()?;
        self.projectiles.get(found)
    }

    /// Hash of all that does not change: the arena's configuration, its creatures' files and configurations, and those
    /// of its fighters. Arenas that fight each other over a network have the same.
    pub fn assets(&self) -> u64 {
        self.assets
    }
}
