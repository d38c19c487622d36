use clamber_colossus::{CreatureConfig, CreatureState, Noise};
use serde::{Deserialize, Serialize};

use super::{Arena, CreatureId, KindId, LAST_NUMBER, Member};
use crate::error::ArenaError;
use crate::fighter::{Fighter, FighterConfig, FighterId, FighterState};
use crate::projectile::Projectile;

/// The complete state of an arena: a plain value, without meshes and caches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArenaState {
    /// [`Arena::config_hash`] of the arena from which it was saved.
    pub config: u64,
    /// Number of ticks stepped so far.
    pub tick: u64,
    /// The creatures, by ascending number ([`CreatureId`]). [`Arena::restore`] refuses any other order.
    pub creatures: Vec<SavedCreature>,
    /// The number that the next creature gets.
    pub next_creature: u32,
    /// The fighters, by ascending number ([`FighterId`]). [`Arena::restore`] refuses any other order.
    pub fighters: Vec<SavedFighter>,
    /// The number that the next fighter gets.
    pub next_fighter: u32,
    /// All projectiles, in flight, stuck or falling, by ascending number. [`Arena::restore`] refuses any other order.
    pub projectiles: Vec<Projectile>,
    /// The number that the next projectile gets.
    pub next_projectile: u64,
    /// Noises of the last step's impacts, which creatures hear in the next step.
    pub noises: Vec<Noise>,
}

/// One creature in a saved arena: its number, kind and configuration, and all of it that changes. Its skeleton, clips
/// and skin are not included; they come from its kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedCreature {
    /// The creature's number.
    pub id: CreatureId,
    /// The creature's kind. The arena that restores it has to know this kind ([`Arena::add_kind`]).
    pub kind: KindId,
    /// The creature's place at first, and its size.
    pub config: CreatureConfig,
    /// All of the creature that changes: its place, clips, brain, wounds, shots and waves.
    pub state: CreatureState,
}

/// One fighter in a saved arena: its number, its configuration, and all of it that changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedFighter {
    /// The fighter's number.
    pub id: FighterId,
    /// The fighter's body and weapons.
    pub config: FighterConfig,
    /// All of the fighter that changes: its climber, its act, its arrows, and whether it is dead.
    pub state: FighterState,
}

impl Arena {
    /// The complete state, to be restored later.
    pub fn save(&self) -> ArenaState {
        let creatures = self.creatures.iter().map(|one| SavedCreature {
            id: one.id,
            kind: one.kind,
            config: *one.creature.config(),
            state: one.creature.state().clone(),
        });
        let fighters = self.fighters.iter().map(|one| SavedFighter {
            id: one.id(),
            config: *one.config(),
            state: one.state(),
        });
        ArenaState {
            config: self.config_hash(),
            tick: self.tick,
            creatures: creatures.collect(),
            next_creature: self.next_creature,
            fighters: fighters.collect(),
            next_fighter: self.next_fighter,
            projectiles: self.projectiles.clone(),
            next_projectile: self.next_projectile,
            noises: self.noises.clone(),
        }
    }

    /// Restores a saved state of this arena, or of another one with the same configuration. The arena continues with
    /// the same bits as after the save. Creatures and fighters that are not in the state are removed, and missing ones
    /// are added. Events of the last step are cleared.
    ///
    /// # Errors
    /// [`ArenaError::Config`] if the state was saved with another configuration, [`ArenaError::Kind`] if this arena
    /// does not know the kind of a creature, and [`ArenaError::OtherArena`], [`ArenaError::OutOfRange`],
    /// [`ArenaError::Climber`] and [`ArenaError::Creature`] if the state is inconsistent or out of range. Nothing is
    /// changed then.
    pub fn restore(&mut self, state: &ArenaState) -> Result<(), ArenaError> {
        self.check_state(state)?;
        let fighters = self.restored_fighters(&state.fighters)?;
        self.restore_creatures(&state.creatures)?;
        match fighters {
            Some(fighters) => self.fighters = fighters,
            None => {
                for (fighter, saved) in self.fighters.iter_mut().zip(&state.fighters) {
                    fighter.restore(&saved.state)?;
                }
            }
        }
        self.projectiles.clone_from(&state.projectiles);
        self.noises.clone_from(&state.noises);
        self.next_creature = state.next_creature;
        self.next_fighter = state.next_fighter;
        self.next_projectile = state.next_projectile;
        self.tick = state.tick;
        self.events.clear();
        Ok(())
    }

    /// Builds fighters in their saved states. `None` if the arena has exactly these fighters already; their states are
    /// then only checked.
    fn restored_fighters(
        &self,
        saved: &[SavedFighter],
    ) -> Result<Option<Vec<Fighter>>, ArenaError> {
        let is_same = |(one, saved): (&Fighter, &SavedFighter)| {
            one.id() == saved.id && *one.config() == saved.config
        };
        let pairs = || self.fighters.iter().zip(saved);
        if self.fighters.len() == saved.len() && pairs().all(is_same) {
            for (fighter, saved) in pairs() {
                fighter.check(&saved.state)?;
            }
            return Ok(None);
        }
        let restored = saved.iter().map(|saved| {
            let mut fighter = self.new_fighter(saved.id, saved.config, saved.state.spawn)?;
            fighter.restore(&saved.state)?;
            Ok(fighter)
        });
        restored.collect::<Result<_, ArenaError>>().map(Some)
    }

    /// Restores all creatures, or changes none of them.
    fn restore_creatures(&mut self, saved: &[SavedCreature]) -> Result<(), ArenaError> {
        let is_same = |(one, saved): (&Member, &SavedCreature)| {
            (one.id, one.kind) == (saved.id, saved.kind) && *one.creature.config() == saved.config
        };
        if self.creatures.len() == saved.len() && self.creatures.iter().zip(saved).all(is_same) {
            return self.swap_creatures(saved.iter().map(|one| one.state.clone()).collect());
        }
        let restored = saved.iter().map(|saved| {
            let mut member = self.new_member(saved.id, saved.kind, saved.config)?;
            member.creature.restore(saved.state.clone())?;
            Ok(member)
        });
        self.creatures = restored.collect::<Result<_, ArenaError>>()?;
        Ok(())
    }

    /// Sets the state of each creature, or changes none of them.
    fn swap_creatures(&mut self, mut states: Vec<CreatureState>) -> Result<(), ArenaError> {
        let mut swapped = 0;
        let mut failed = None;
        for (one, state) in self.creatures.iter_mut().zip(&mut states) {
            if let Err(error) = one.creature.swap_state(state) {
                failed = Some(error);
                break;
            }
            swapped += 1;
        }
        let Some(error) = failed else {
            return Ok(());
        };
        for (one, before) in self.creatures.iter_mut().zip(&mut states).take(swapped) {
            one.creature.swap_state(before)?;
        }
        Err(error.into())
    }

    fn check_state(&self, state: &ArenaState) -> Result<(), ArenaError> {
        let (found, expected) = (state.config, self.config_hash());
        if found != expected {
            return Err(ArenaError::Config { found, expected });
        }
        let other = |reason| Err(ArenaError::OtherArena(reason));
        // No run counts this far, and the limit leaves room to count on without an overflow.
        let far = state.tick.max(state.next_projectile) > u64::MAX / 2;
        if far || state.next_creature.max(state.next_fighter) > LAST_NUMBER {
            return other("its counters are further than an arena counts");
        }
        let creatures = state.creatures.iter().map(|one| one.id.0);
        let fighters = state.fighters.iter().map(|one| one.id.0);
        if !are_in_order(creatures, state.next_creature)
            || !are_in_order(fighters, state.next_fighter)
        {
            return other("the numbers of its creatures or fighters are not in order");
        }
        if !state.fighters.iter().all(|one| one.state.is_finite()) {
            return other("what a fighter does is out of range");
        }
        if !state.projectiles.is_sorted_by(|a, b| a.id < b.id) {
            return other("its projectiles are not in order");
        }
        for one in &state.projectiles {
            if one.by.0 >= state.next_fighter {
                return other("a projectile was shot by nobody");
            }
            if one.id.0 >= state.next_projectile {
                return other("a projectile has a number that was not given yet");
            }
            if !one.is_finite() {
                return other("a projectile is not at a finite place");
            }
        }
        let is_heard = |noise: &Noise| noise.place.is_finite() && noise.loudness.is_finite();
        if !state.noises.iter().all(is_heard) {
            return other("a noise is not at a finite place");
        }
        Ok(())
    }
}

/// True if the numbers ascend and all are below `next`.
fn are_in_order(numbers: impl Iterator<Item = u32> + Clone, next: u32) -> bool {
    numbers.clone().is_sorted_by(|a, b| a < b) && numbers.last().is_none_or(|last| last < next)
}
