use clamber_colossus::{CreatureState, Noise};
use serde::{Deserialize, Serialize};

use super::Arena;
use crate::error::ArenaError;
use crate::fighter::FighterState;
use crate::projectile::Projectile;

/// All that changes in an arena: a plain value, without meshes, caches and configurations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ArenaState {
    /// [`Arena::assets`] of the arena that it is of.
    pub assets: u64,
    /// Ticks so far.
    pub tick: u64,
    /// The creatures, by number.
    pub creatures: Vec<CreatureState>,
    /// The fighters, by number.
    pub fighters: Vec<FighterState>,
    /// Arrows and stones, by ascending number.
    pub projectiles: Vec<Projectile>,
    /// The number that the next projectile gets.
    pub next_projectile: u64,
    /// What creatures hear in the next step.
    pub noises: Vec<Noise>,
}

impl Arena {
    /// All that changes, to be restored later.
    pub fn save(&self) -> ArenaState {
        ArenaState {
            assets: self.assets,
            tick: self.tick,
            creatures: self
                .creatures
                .iter()
                .map(|one| one.state().clone())
                .collect(),
            fighters: self.fighters.iter().map(|one| one.state()).collect(),
            projectiles: self.projectiles.clone(),
            next_projectile: self.next_projectile,
            noises: self.noises.clone(),
        }
    }

    /// Goes back to a saved state: all goes on with the same bits as it did then. Events of the last step are
    /// forgotten.
    ///
    /// # Errors
    /// [`ArenaError::Assets`] if it is of another arena, and [`ArenaError::OtherArena`], [`ArenaError::Climber`] and
    /// [`ArenaError::Creature`] if it was changed to what cannot be. Nothing is changed then.
    pub fn restore(&mut self, state: &ArenaState) -> Result<(), ArenaError> {
        self.check_state(state)?;
        for (fighter, saved) in self.fighters.iter().zip(&state.fighters) {
            fighter.check(saved)?;
        }
        self.swap_creatures(state.creatures.clone())?;
        for (fighter, saved) in self.fighters.iter_mut().zip(&state.fighters) {
            fighter.restore(saved)?;
        }
        self.projectiles.clone_from(&state.projectiles);
        self.noises.clone_from(&state.noises);
        self.next_projectile = state.next_projectile;
        self.tick = state.tick;
        self.events.clear();
        Ok(())
    }

    /// Gives each creature its state, or none of them.
    fn swap_creatures(&mut self, mut states: Vec<CreatureState>) -> Result<(), ArenaError> {
        let mut swapped = 0;
        let mut failed = None;
        for (creature, state) in self.creatures.iter_mut().zip(&mut states) {
            if let Err(error) = creature.swap_state(state) {
                failed = Some(error);
                break;
            }
            swapped += 1;
        }
        let Some(error) = failed else {
            return Ok(());
        };
        for (creature, before) in self.creatures.iter_mut().zip(&mut states).take(swapped) {
            creature.swap_state(before)?;
        }
        Err(error.into())
    }

    fn check_state(&self, state: &ArenaState) -> Result<(), ArenaError> {
        let (found, expected) = (state.assets, self.assets);
        if found != expected {
            return Err(ArenaError::Assets { found, expected });
        }
        let other = |reason| Err(ArenaError::OtherArena(reason));
        if state.creatures.len() != self.creatures.len() {
            return other("it has another number of creatures");
        }
        if state.fighters.len() != self.fighters.len() {
            return other("it has another number of fighters");
        }
        if !state.fighters.iter().all(FighterState::is_finite) {
            return other("what a fighter does is out of range");
        }
        if !state.projectiles.is_sorted_by(|a, b| a.id < b.id) {
            return other("its projectiles are not in order");
        }
        let fighters = self.fighters.len();
        for one in &state.projectiles {
            if one.by.0 as usize >= fighters {
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
