//! The arena: creatures, fighters and projectiles, stepped together in a fixed order.

mod aimed;
mod config;
mod event;
mod file;
mod fingerprint;
mod light;
mod member;
mod order;
mod outcome;
mod state;
mod step;

use clamber_colossus::{Creature, CreatureConfig, CreatureKind};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

pub use aimed::Aimed;
pub use config::ArenaConfig;
pub use event::{ArenaEvent, Weapon};
pub use fingerprint::ArenaPart;
pub(crate) use fingerprint::hash_of;
pub use light::SwordLight;
use member::Member;
pub(crate) use member::Skins;
pub use member::{CreatureId, KindId};
pub use order::Order;
pub(crate) use outcome::{Hit, Outcome};
pub use state::{ArenaState, SavedCreature, SavedFighter};

use crate::error::ArenaError;
use crate::fighter::{Fighter, FighterConfig, FighterId};
use crate::projectile::{Projectile, ProjectileId, ProjectileMotion, ProjectilePlace, place_on};

/// Numbers of creatures and fighters are below this, so that the counters do not overflow.
const LAST_NUMBER: u32 = u32::MAX - 1024;

/// Smallest obstacle id of a creature. Terrain ids, for example the bits of an engine's entities, have to be below it.
const FIRST_CREATURE_ID: u64 = 1 << 62;
/// Smallest obstacle id of a fighter.
const FIRST_FIGHTER_ID: u64 = 1 << 63;

/// The obstacle id of a creature. Climbers' states and contacts refer to the creature by it.
pub const fn creature_obstacle(creature: CreatureId) -> ObstacleId {
    ObstacleId(FIRST_CREATURE_ID + creature.0 as u64)
}

/// The obstacle id under which the other fighters see a fighter.
pub const fn fighter_obstacle(fighter: FighterId) -> ObstacleId {
    ObstacleId(FIRST_FIGHTER_ID + fighter.0 as u64)
}

/// The creature with an obstacle id; `None` for terrain and fighters.
pub(crate) fn creature_of(obstacle: ObstacleId) -> Option<CreatureId> {
    let number = obstacle.0.checked_sub(FIRST_CREATURE_ID)?;
    Some(CreatureId(u32::try_from(number).ok()?))
}

/// A whole fight as one value: creatures, fighters, projectiles, and their random streams. A step takes a list of
/// inputs.
///
/// The game owns the terrain: it is passed to each step, and is not saved. When a step is repeated, terrain that moves
/// has to be where it was.
#[derive(Clone, Debug)]
pub struct Arena {
    config: ArenaConfig,
    kinds: BTreeMap<KindId, Arc<CreatureKind>>,
    /// By ascending number, like `fighters`.
    creatures: Vec<Member>,
    next_creature: u32,
    fighters: Vec<Fighter>,
    next_fighter: u32,
    /// By ascending number.
    projectiles: Vec<Projectile>,
    next_projectile: u64,
    noises: Vec<clamber_colossus::Noise>,
    tick: u64,
    events: Vec<ArenaEvent>,
    scratch: step::Scratch,
}

impl Arena {
    /// An arena without creatures and fighters.
    ///
    /// # Errors
    /// [`ArenaError::OutOfRange`] for a configuration outside its ranges.
    pub fn new(config: ArenaConfig) -> Result<Self, ArenaError> {
        config.check()?;
        Ok(Self {
            config,
            kinds: BTreeMap::new(),
            creatures: Vec::new(),
            next_creature: 0,
            fighters: Vec::new(),
            next_fighter: 0,
            projectiles: Vec::new(),
            next_projectile: 0,
            noises: Vec::new(),
            tick: 0,
            events: Vec::new(),
            scratch: step::Scratch::default(),
        })
    }

    /// Registers a kind of creature. Creatures of this kind can then join ([`Order::AddCreature`]), and states that
    /// contain them can be restored. Kinds can be registered at any time and in any order; nothing else changes.
    ///
    /// # Errors
    /// [`ArenaError::Tick`] if its brain was made for another tick.
    pub fn add_kind(&mut self, kind: Arc<CreatureKind>) -> Result<KindId, ArenaError> {
        let (creature, arena) = (kind.brain().tick(), self.config.tick);
        if creature != arena {
            return Err(ArenaError::Tick { creature, arena });
        }
        let id = KindId(kind.fingerprint());
        self.kinds.entry(id).or_insert(kind);
        Ok(id)
    }

    /// Adds a creature before the first step. After it, use [`Order::AddCreature`].
    ///
    /// # Errors
    /// [`ArenaError::Begun`] after the first step, [`ArenaError::Tick`] if its brain was made for another tick, and
    /// [`ArenaError::Creature`] for the errors of [`Creature::new`].
    pub fn add_creature(
        &mut self,
        kind: Arc<CreatureKind>,
        config: CreatureConfig,
    ) -> Result<CreatureId, ArenaError> {
        self.check_new()?;
        let kind = self.add_kind(kind)?;
        let member = self.new_member(CreatureId(self.next_creature), kind, config)?;
        Ok(self.join_creature(member))
    }

    /// Adds a fighter before the first step, in the air and without velocity: it falls. `position` is the centre of its
    /// climber's ball, and its spawn point after a death. If that place is not free in the first step, the fighter is
    /// moved aside; the spawn point stays. After the first step, use [`Order::AddFighter`].
    ///
    /// # Errors
    /// [`ArenaError::Begun`] after the first step, [`ArenaError::OutOfRange`] for numbers of its weapons outside their
    /// ranges, and [`ArenaError::Climber`] for its climber's configuration, or a position that is not finite.
    pub fn add_fighter(
        &mut self,
        config: FighterConfig,
        position: DVec3,
    ) -> Result<FighterId, ArenaError> {
        self.check_new()?;
        let fighter = self.new_fighter(FighterId(self.next_fighter), config, position)?;
        Ok(self.join_fighter(fighter))
    }

    fn check_new(&self) -> Result<(), ArenaError> {
        if self.tick > 0 {
            return Err(ArenaError::Begun);
        }
        if self.next_fighter.max(self.next_creature) >= LAST_NUMBER {
            return Err(ArenaError::OutOfRange {
                name: "the next number",
                range: "one that is left: this many were never given",
                found: f64::from(self.next_fighter.max(self.next_creature)),
            });
        }
        Ok(())
    }

    fn new_member(
        &self,
        id: CreatureId,
        kind: KindId,
        config: CreatureConfig,
    ) -> Result<Member, ArenaError> {
        let known = self.kinds.get(&kind).ok_or(ArenaError::Kind { kind })?;
        Member::new(id, (kind, known), config)
    }

    fn new_fighter(
        &self,
        id: FighterId,
        config: FighterConfig,
        position: DVec3,
    ) -> Result<Fighter, ArenaError> {
        let number = u64::from(id.0).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Fighter::new(id, config, position, self.config.seed.wrapping_add(number))
    }

    fn join_creature(&mut self, member: Member) -> CreatureId {
        let id = member.id;
        self.next_creature = id.0 + 1;
        self.creatures.push(member);
        id
    }

    fn join_fighter(&mut self, fighter: Fighter) -> FighterId {
        let id = fighter.id();
        self.next_fighter = id.0 + 1;
        self.fighters.push(fighter);
        id
    }

    /// The configuration.
    pub fn config(&self) -> &ArenaConfig {
        &self.config
    }

    /// Number of ticks stepped so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The registered kinds of creatures.
    pub fn kinds(&self) -> impl ExactSizeIterator<Item = (KindId, &Arc<CreatureKind>)> {
        self.kinds.iter().map(|(id, kind)| (*id, kind))
    }

    /// The creatures, by ascending number ([`CreatureId`]).
    pub fn creatures(&self) -> impl ExactSizeIterator<Item = (CreatureId, &Creature)> + Clone {
        self.creatures.iter().map(|one| (one.id, &one.creature))
    }

    /// A creature; `None` if there is no such creature, or if it has left.
    pub fn creature(&self, id: CreatureId) -> Option<&Creature> {
        Some(&self.creatures.get(self.creature_index(id)?)?.creature)
    }

    /// The number that the next creature gets.
    pub fn next_creature(&self) -> CreatureId {
        CreatureId(self.next_creature)
    }

    /// The fighters, by ascending number ([`FighterId`]).
    pub fn fighters(&self) -> &[Fighter] {
        &self.fighters
    }

    /// A fighter; `None` if there is no such fighter, or if it has left.
    pub fn fighter(&self, id: FighterId) -> Option<&Fighter> {
        self.fighters.get(self.fighter_index(id)?)
    }

    /// The number that the next fighter gets.
    pub fn next_fighter(&self) -> FighterId {
        FighterId(self.next_fighter)
    }

    fn creature_index(&self, id: CreatureId) -> Option<usize> {
        self.creatures.binary_search_by_key(&id, |one| one.id).ok()
    }

    fn creature_mut(&mut self, id: CreatureId) -> Option<&mut Creature> {
        let index = self.creature_index(id)?;
        Some(&mut self.creatures.get_mut(index)?.creature)
    }

    fn fighter_index(&self, id: FighterId) -> Option<usize> {
        self.fighters.binary_search_by_key(&id, Fighter::id).ok()
    }

    /// All projectiles, by ascending number: arrows and stones in flight, stuck arrows, and arrows that came loose. A
    /// stone is removed at its first contact, any projectile in flight after 20 s. A stuck arrow falls if its material
    /// is gone, or if it is the oldest and more than [`ArenaConfig::stuck_arrows`] stick.
    pub fn projectiles(&self) -> &[Projectile] {
        &self.projectiles
    }

    /// Events of the last step, in the order in which the step produced them: by its phases ([`Arena::step`]), and the
    /// blows of creatures last. Only hits ([`ArenaEvent::Hit`]) are among themselves in the order of their times within
    /// the tick. The next step replaces the events. Empty before the first step and after a restore.
    pub fn events(&self) -> &[ArenaEvent] {
        &self.events
    }

    /// Position and direction of a projectile after the last step, whose terrain is given again. `None` if it sticks in
    /// a creature, a part of its skin or terrain that is gone, or in terrain that `terrain` does not list.
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
            ProjectileMotion::Stuck { at, direction } => match creature_of(at.obstacle) {
                Some(creature) => place_on(at, *direction, self.creature(creature)?.surface()),
                None => {
                    let (_, obstacle) = terrain.iter().find(|(id, _)| *id == at.obstacle)?;
                    place_on(at, *direction, *obstacle)
                }
            },
        }
    }

    /// The projectile with a number; `None` if it was removed, or if no projectile has had the number yet.
    pub fn projectile(&self, id: ProjectileId) -> Option<&Projectile> {
        let found = self
            .projectiles
            .binary_search_by_key(&id, |one| one.id)
            .ok()?;
        self.projectiles.get(found)
    }

    /// Hash of the [`ArenaConfig`] alone: peers over a network, saved states and recordings must agree on it.
    /// [`Arena::fingerprint`] covers creatures and fighters with their configurations; neither covers terrain.
    pub fn config_hash(&self) -> u64 {
        hash_of(0, &self.config)
    }
}
