//! A hash of the arena's state. It is computed from the values that are saved, by serialising them into a hasher.

use postcard::ser_flavors::Flavor;
use serde::Serialize;

use clamber_climber::ClimberState;
use clamber_colossus::CreatureState;
use clamber_surface::Fingerprint;

use super::member::mark;
use super::{Arena, ArenaState, CreatureId};
use crate::fighter::{FighterId, FighterState, fighter_mark};

/// A part of an arena of which [`Arena::part_fingerprints`] has a hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum ArenaPart {
    /// A creature.
    Creature(CreatureId),
    /// A fighter.
    Fighter(FighterId),
    /// Projectiles, noises and counters.
    Rest,
}

impl Arena {
    /// A 64-bit hash of everything that [`Arena::save`] saves, except the hash of the configuration. For comparing runs
    /// and peers; not for hash tables.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fingerprint::default();
        self.take_counters(&mut hash);
        for one in &self.creatures {
            take_creature(&mut hash, one.mark, one.creature.state());
        }
        for fighter in &self.fighters {
            let climber = fighter.climber().state();
            take_fighter(&mut hash, fighter.mark(), climber, fighter.rest());
        }
        take(&mut hash, &(&self.projectiles, &self.noises));
        hash.value()
    }

    /// Hashes of the single parts, to find the parts that differ: each creature, then each fighter, then the rest.
    pub fn part_fingerprints(&self) -> Vec<(ArenaPart, u64)> {
        let creatures = self.creatures.iter().map(|one| {
            let mut hash = Fingerprint::default();
            take_creature(&mut hash, one.mark, one.creature.state());
            (ArenaPart::Creature(one.id), hash.value())
        });
        let fighters = self.fighters.iter().map(|fighter| {
            let mut hash = Fingerprint::default();
            let climber = fighter.climber().state();
            take_fighter(&mut hash, fighter.mark(), climber, fighter.rest());
            (ArenaPart::Fighter(fighter.id()), hash.value())
        });
        let mut rest = Fingerprint::default();
        self.take_counters(&mut rest);
        take(&mut rest, &(&self.projectiles, &self.noises));
        let rest = (ArenaPart::Rest, rest.value());
        creatures.chain(fighters).chain([rest]).collect()
    }

    fn take_counters(&self, hash: &mut Fingerprint) {
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        take(hash, &(self.tick, next));
    }
}

impl ArenaState {
    /// The same hash as [`Arena::fingerprint`] of the arena from which this state was saved.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fingerprint::default();
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        take(&mut hash, &(self.tick, next));
        for one in &self.creatures {
            let mark = mark(one.id, one.kind, &one.config);
            take_creature(&mut hash, mark, &one.state);
        }
        for one in &self.fighters {
            let mark = fighter_mark(one.id, &one.config);
            take_fighter(&mut hash, mark, &one.state.climber, &one.state);
        }
        take(&mut hash, &(&self.projectiles, &self.noises));
        hash.value()
    }
}

fn take_creature(hash: &mut Fingerprint, mark: u64, state: &CreatureState) {
    hash.word(mark);
    take(hash, state);
}

fn take_fighter(hash: &mut Fingerprint, mark: u64, climber: &ClimberState, state: &FighterState) {
    hash.word(mark);
    take(hash, climber);
    add_fighter(hash, state);
}

/// Hashes a fighter's state without its climber.
fn add_fighter(hash: &mut Fingerprint, state: &FighterState) {
    let FighterState {
        climber: _,
        act,
        actions,
        knockback,
        harm,
        hit_stop,
        dead,
        arrows,
        random,
        has_begun,
        spawn,
    } = state;
    take(
        hash,
        &(
            act, actions, knockback, harm, hit_stop, dead, arrows, random,
        ),
    );
    take(hash, &(has_begun, spawn));
}

/// Hash of a value in its serialised form.
pub(crate) fn hash_of(start: u64, value: &impl Serialize) -> u64 {
    let mut hash = Fingerprint::new(start);
    take(&mut hash, value);
    hash.value()
}

/// Hashes what postcard writes.
struct Hasher(Fingerprint);

impl Flavor for Hasher {
    type Output = Fingerprint;

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.bytes(bytes);
        Ok(())
    }

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0.word(u64::from(byte));
        Ok(())
    }

    fn finalize(self) -> postcard::Result<Fingerprint> {
        Ok(self.0)
    }
}

/// Adds a value in the form in which postcard writes it.
fn take(hash: &mut Fingerprint, value: &impl Serialize) {
    // Postcard fails only for sequences of unknown length, and a state has none. If one had, the error would be hashed
    // instead of it.
    match postcard::serialize_with_flavor(value, Hasher(*hash)) {
        Ok(next) => *hash = next,
        Err(error) => hash.text(&error.to_string()),
    }
}
