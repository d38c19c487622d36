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
    /// and peers; not for hash tables.
    pub fn fingerprint(&self) -> u64 {
        alone(|hash| {
            self.take_counters(hash);
            for one in &self.creatures {
                take_creature(hash, one.mark, one.creature.state());
            }
            for fighter in &self.fighters {
                let climber = fighter.climber().state();
                take_fighter(hash, fighter.mark(), climber, fighter.rest());
            }
            self.take_last(hash);
        })
    }

    /// Hashes of the single parts, to find the parts that differ: each creature, then each fighter, then the rest.
    pub fn part_fingerprints(&self) -> Vec<(ArenaPart, u64)> {
        let creatures = self.creatures.iter().map(|one| {
            let state = one.creature.state();
            let hash = alone(|hash| take_creature(hash, one.mark, state));
            (ArenaPart::Creature(one.id), hash)
        });
        let fighters = self.fighters.iter().map(|fighter| {
            let climber = fighter.climber().state();
            let hash = alone(|hash| take_fighter(hash, fighter.mark(), climber, fighter.rest()));
            (ArenaPart::Fighter(fighter.id()), hash)
        });
        let rest = alone(|hash| {
            self.take_counters(hash);
            self.take_last(hash);
        });
        let rest = [(ArenaPart::Rest, rest)];
        creatures.chain(fighters).chain(rest).collect()
    }

    /// [`Arena::fingerprint`] and [`Arena::part_fingerprints`], in one pass over the state.
    pub fn fingerprints(&self) -> (u64, Vec<(ArenaPart, u64)>) {
        let mut parts = Vec::with_capacity(self.creatures.len() + self.fighters.len() + 1);
        let mut ends = [Fingerprint::default(); 2];
        self.take_counters(&mut ends);
        let [mut all, rest] = ends;
        for one in &self.creatures {
            let mut both = [all, Fingerprint::default()];
            take_creature(&mut both, one.mark, one.creature.state());
            all = both[0];
            parts.push((ArenaPart::Creature(one.id), both[1].value()));
        }
        for fighter in &self.fighters {
            let mut both = [all, Fingerprint::default()];
            let climber = fighter.climber().state();
            take_fighter(&mut both, fighter.mark(), climber, fighter.rest());
            all = both[0];
            parts.push((ArenaPart::Fighter(fighter.id()), both[1].value()));
        }
        let mut ends = [all, rest];
        self.take_last(&mut ends);
        let [all, rest] = ends;
        parts.push((ArenaPart::Rest, rest.value()));
        (all.value(), parts)
    }

    /// Hashes the numbers of the tick and of those who join next. They are hashed before creatures and fighters.
    fn take_counters<const N: usize>(&self, hashes: &mut [Fingerprint; N]) {
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        take(hashes, &(self.tick, next));
    }

    /// Hashes projectiles and noises. They are hashed after creatures and fighters.
    fn take_last<const N: usize>(&self, hashes: &mut [Fingerprint; N]) {
        take(hashes, &(&self.projectiles, &self.noises));
    }
}

impl ArenaState {
    /// The same hash as [`Arena::fingerprint`] of the arena from which this state was saved.
    pub fn fingerprint(&self) -> u64 {
        alone(|hash| {
            let next = (self.next_creature, self.next_fighter, self.next_projectile);
            take(hash, &(self.tick, next));
            for one in &self.creatures {
                let mark = mark(one.id, one.kind, &one.config);
                take_creature(hash, mark, &one.state);
            }
            for one in &self.fighters {
                let mark = fighter_mark(one.id, &one.config);
                take_fighter(hash, mark, &one.state.climber, &one.state);
            }
            take(hash, &(&self.projectiles, &self.noises));
        })
    }
}

/// The hash of what `add` adds to it.
fn alone(add: impl FnOnce(&mut [Fingerprint; 1])) -> u64 {
    let mut hash = [Fingerprint::default()];
    add(&mut hash);
    let [hash] = hash;
    hash.value()
}

fn take_creature<const N: usize>(hashes: &mut [Fingerprint; N], mark: u64, state: &CreatureState) {
    take_mark(hashes, mark);
    take(hashes, state);
}

fn take_fighter<const N: usize>(
    hashes: &mut [Fingerprint; N],
    mark: u64,
    climber: &ClimberState,
    state: &FighterState,
) {
    take_mark(hashes, mark);
    take(hashes, climber);
    add_fighter(hashes, state);
}

fn take_mark(hashes: &mut [Fingerprint], mark: u64) {
    for hash in hashes {
        hash.word(mark);
    }
}

/// Hashes a fighter's state without its climber.
fn add_fighter<const N: usize>(hashes: &mut [Fingerprint; N], state: &FighterState) {
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
        hashes,
        &(
            act, actions, knockback, harm, hit_stop, dead, arrows, random,
        ),
    );
    take(hashes, &(has_begun, spawn));
}

/// Hash of a value in its serialised form.
pub(crate) fn hash_of(start: u64, value: &impl Serialize) -> u64 {
    let mut hash = [Fingerprint::new(start)];
    take(&mut hash, value);
    let [hash] = hash;
    hash.value()
}

/// Adds what postcard writes to each of some hashes.
struct Hasher<const N: usize>([Fingerprint; N]);

impl<const N: usize> Flavor for Hasher<N> {
    type Output = [Fingerprint; N];

    #[inline]
    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        for hash in &mut self.0 {
            hash.bytes(bytes);
        }
        Ok(())
    }

    #[inline]
    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        for hash in &mut self.0 {
            hash.word(u64::from(byte));
        }
        Ok(())
    }

    fn finalize(self) -> postcard::Result<[Fingerprint; N]> {
        Ok(self.0)
    }
}

/// Adds a value, in the form in which postcard writes it, to each of some hashes.
fn take<const N: usize>(hashes: &mut [Fingerprint; N], value: &impl Serialize) {
    // Postcard fails only for sequences of unknown length, and a state has none. If one had, the error would be hashed
    // instead of it.
    match postcard::serialize_with_flavor(value, Hasher(*hashes)) {
        Ok(next) => *hashes = next,
        Err(error) => {
            let error = error.to_string();
            for hash in hashes {
                hash.text(&error);
            }
        }
    }
}
