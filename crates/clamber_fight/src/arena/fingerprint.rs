//! A hash of the arena's state. It is computed from the values that are saved, by serialising them into a hasher.

use postcard::ser_flavors::Flavor;
use serde::Serialize;

use clamber_climber::ClimberState;
use clamber_colossus::CreatureState;
use clamber_surface::Fingerprint;

use super::member::mark;
use super::{Arena, ArenaState, CreatureId};
use crate::fighter::{FighterId, FighterState, fighter_mark};

/// A part of an arena of which [`Arena::part_fingerprints`] has a hash: one creature, one fighter, or all the rest. It
/// tells in which part two peers or two runs differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum ArenaPart {
    /// One creature, with its shots and waves.
    Creature(CreatureId),
    /// One fighter, without its projectiles.
    Fighter(FighterId),
    /// All projectiles of fighters, the noises, the number of ticks, and the numbers that are given next.
    Rest,
}

impl Arena {
    /// A 64-bit hash of everything that [`Arena::save`] saves, except the hash of the configuration. For comparing runs
    /// and peers; not for hash tables. It is the hash of all [`Arena::part_fingerprints`].
    pub fn fingerprint(&self) -> u64 {
        whole(self.parts())
    }

    /// Hashes of the single parts, to find the parts that differ: each creature, then each fighter, then the rest.
    pub fn part_fingerprints(&self) -> Vec<(ArenaPart, u64)> {
        self.parts().collect()
    }

    fn parts(&self) -> impl Iterator<Item = (ArenaPart, u64)> {
        let creatures = self.creatures.iter().map(|one| {
            let hash = of_creature(one.mark, one.creature.state());
            (ArenaPart::Creature(one.id), hash)
        });
        let fighters = self.fighters.iter().map(|fighter| {
            let climber = fighter.climber().state();
            let hash = of_fighter(fighter.mark(), climber, fighter.rest());
            (ArenaPart::Fighter(fighter.id()), hash)
        });
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        let rest = of_rest(self.tick, next, &(&self.projectiles, &self.noises));
        creatures.chain(fighters).chain([(ArenaPart::Rest, rest)])
    }
}

impl ArenaState {
    /// The same hash as [`Arena::fingerprint`] of the arena from which this state was saved.
    pub fn fingerprint(&self) -> u64 {
        let creatures = self.creatures.iter().map(|one| {
            let mark = mark(one.id, one.kind, &one.config);
            (ArenaPart::Creature(one.id), of_creature(mark, &one.state))
        });
        let fighters = self.fighters.iter().map(|one| {
            let mark = fighter_mark(one.id, &one.config);
            let hash = of_fighter(mark, &one.state.climber, &one.state);
            (ArenaPart::Fighter(one.id), hash)
        });
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        let rest = of_rest(self.tick, next, &(&self.projectiles, &self.noises));
        whole(creatures.chain(fighters).chain([(ArenaPart::Rest, rest)]))
    }
}

/// The hash of an arena whose parts have these hashes. The hash of a creature or a fighter covers its number, so the
/// numbers themselves are not hashed again.
fn whole(parts: impl Iterator<Item = (ArenaPart, u64)>) -> u64 {
    let mut all = Fingerprint::default();
    for (_, part) in parts {
        all.word(part);
    }
    all.value()
}

/// Hash of a creature. `mark` is the hash of what never changes: number, kind and configuration.
fn of_creature(mark: u64, state: &CreatureState) -> u64 {
    hash_of(mark, state)
}

/// Hash of a fighter; the climber in `state` is ignored. `mark` is the hash of number and configuration.
fn of_fighter(mark: u64, climber: &ClimberState, state: &FighterState) -> u64 {
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
    let weapons = (act, actions, knockback, harm, hit_stop);
    hash_of(
        mark,
        &(climber, weapons, dead, arrows, random, has_begun, spawn),
    )
}

/// Hash of what belongs to no creature and no fighter: number of ticks, numbers of those who join next, projectiles and
/// noises.
fn of_rest(tick: u64, next: (u32, u32, u64), flying: &impl Serialize) -> u64 {
    hash_of(0, &(tick, next, flying))
}

/// Hash of a value, as postcard writes it. Equal values that start from different seeds have different hashes.
pub(crate) fn hash_of(seed: u64, value: &impl Serialize) -> u64 {
    // Postcard fails only for sequences of unknown length, and a state has none. If one had, the error would be hashed
    // instead of it.
    postcard::serialize_with_flavor(value, Hasher(Fingerprint::new(seed))).unwrap_or_else(|error| {
        let mut hash = Fingerprint::new(seed);
        hash.text(&error.to_string());
        hash.value()
    })
}

/// Hashes what postcard writes.
struct Hasher(Fingerprint);

impl Flavor for Hasher {
    type Output = u64;

    #[inline]
    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.bytes(bytes);
        Ok(())
    }

    #[inline]
    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.0.word(u64::from(byte));
        Ok(())
    }

    fn finalize(self) -> postcard::Result<u64> {
        Ok(self.0.value())
    }
}
