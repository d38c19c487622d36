//! A hash of the arena's state. It is computed from the values that are saved, by serialising them into a hasher.

use std::fmt::Display;

use serde::Serialize;
use serde::ser::{
    self, SerializeMap, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple,
    SerializeTupleStruct, SerializeTupleVariant,
};

use clamber_climber::ClimberState;
use clamber_colossus::CreatureState;

use super::member::mark;
use super::{Arena, ArenaState, CreatureId};
use crate::fighter::{FighterId, FighterState, fighter_mark};

/// A part of an arena.
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
        let mut hash = Hasher::default();
        self.take_counters(&mut hash);
        for one in &self.creatures {
            take_creature(&mut hash, one.mark, one.creature.state());
        }
        for fighter in &self.fighters {
            let climber = fighter.climber().state();
            take_fighter(&mut hash, fighter.mark(), climber, fighter.rest());
        }
        hash.take(&(&self.projectiles, &self.noises));
        hash.hash()
    }

    /// Hashes of the single parts, to find the parts that differ: each creature, then each fighter, then the rest.
    pub fn part_fingerprints(&self) -> Vec<(ArenaPart, u64)> {
        let creatures = self.creatures.iter().map(|one| {
            let mut hash = Hasher::default();
            take_creature(&mut hash, one.mark, one.creature.state());
            (ArenaPart::Creature(one.id), hash.hash())
        });
        let fighters = self.fighters.iter().map(|fighter| {
            let mut hash = Hasher::default();
            let climber = fighter.climber().state();
            take_fighter(&mut hash, fighter.mark(), climber, fighter.rest());
            (ArenaPart::Fighter(fighter.id()), hash.hash())
        });
        let mut rest = Hasher::default();
        self.take_counters(&mut rest);
        rest.take(&(&self.projectiles, &self.noises));
        let rest = (ArenaPart::Rest, rest.hash());
        creatures.chain(fighters).chain([rest]).collect()
    }

    fn take_counters(&self, hash: &mut Hasher) {
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        hash.take(&(self.tick, next));
    }
}

impl ArenaState {
    /// The same hash as [`Arena::fingerprint`] of the arena from which this state was saved.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Hasher::default();
        let next = (self.next_creature, self.next_fighter, self.next_projectile);
        hash.take(&(self.tick, next));
        for one in &self.creatures {
            let mark = mark(one.id, one.kind, &one.config);
            take_creature(&mut hash, mark, &one.state);
        }
        for one in &self.fighters {
            let mark = fighter_mark(one.id, &one.config);
            take_fighter(&mut hash, mark, &one.state.climber, &one.state);
        }
        hash.take(&(&self.projectiles, &self.noises));
        hash.hash()
    }
}

fn take_creature(hash: &mut Hasher, mark: u64, state: &CreatureState) {
    hash.word(mark);
    hash.take(state);
}

fn take_fighter(hash: &mut Hasher, mark: u64, climber: &ClimberState, state: &FighterState) {
    hash.word(mark);
    hash.take(climber);
    add_fighter(hash, state);
}

/// Hashes a fighter's state without its climber.
fn add_fighter(hash: &mut Hasher, state: &FighterState) {
    let FighterState {
        climber: _,
        act,
        actions,
        blow,
        harm,
        hit_stop,
        dead,
        arrows,
        random,
        has_begun,
        spawn,
    } = state;
    hash.take(&(act, actions, blow, harm, hit_stop, dead, arrows, random));
    hash.take(&(has_begun, spawn));
}

/// Hash of a value in its serialised form.
pub(crate) fn hash_of(start: u64, value: &impl Serialize) -> u64 {
    let mut hash = Hasher::new(start);
    hash.take(value);
    hash.hash()
}

/// Hashes 64-bit words one after another, with one multiplication each.
///
/// Two hashes take turns: within one hash each multiplication waits for the one before it.
#[derive(Clone, Copy, Debug)]
struct Hasher([u64; 2]);

impl Default for Hasher {
    fn default() -> Self {
        Self::new(0xcbf2_9ce4_8422_2325)
    }
}

impl Hasher {
    fn new(start: u64) -> Self {
        Self([start, !start])
    }

    fn word(&mut self, word: u64) {
        let [turn, other] = self.0;
        self.0 = [other, add(turn, word)];
    }

    fn hash(&self) -> u64 {
        add(self.0[0], self.0[1])
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.word(bytes.len() as u64);
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.word(u64::from_le_bytes(word));
        }
    }

    fn take(&mut self, value: &impl Serialize) {
        // The hasher returns no error.
        let _ = value.serialize(self);
    }
}

fn add(hash: u64, word: u64) -> u64 {
    // 2^64 divided by the golden ratio: an odd number with well spread bits.
    (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

/// The error type that serde requires. The hasher never returns it.
#[derive(Debug)]
struct Never;

impl Display for Never {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("cannot be hashed")
    }
}

impl std::error::Error for Never {}

impl ser::Error for Never {
    fn custom<T: Display>(_: T) -> Self {
        Self
    }
}

macro_rules! words {
    ($($name:ident: $kind:ty),*) => { $(
        fn $name(self, v: $kind) -> Result<(), Never> {
            self.word(v as u64);
            Ok(())
        }
    )* };
}

impl ser::Serializer for &mut Hasher {
    type Ok = ();
    type Error = Never;
    type SerializeSeq = Self;
    type SerializeTuple = Self;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = Self;
    type SerializeStruct = Self;
    type SerializeStructVariant = Self;

    words!(
        serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_char: char
    );

    fn serialize_f32(self, v: f32) -> Result<(), Never> {
        self.word(u64::from(v.to_bits()));
        Ok(())
    }

    fn serialize_f64(self, v: f64) -> Result<(), Never> {
        self.word(v.to_bits());
        Ok(())
    }

    fn serialize_str(self, v: &str) -> Result<(), Never> {
        self.bytes(v.as_bytes());
        Ok(())
    }

    fn serialize_bytes(self, v: &[u8]) -> Result<(), Never> {
        self.bytes(v);
        Ok(())
    }

    fn serialize_none(self) -> Result<(), Never> {
        self.word(0);
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Never> {
        self.word(1);
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<(), Never> {
        Ok(())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<(), Never> {
        Ok(())
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
    ) -> Result<(), Never> {
        self.word(u64::from(index));
        Ok(())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Never> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), Never> {
        self.word(u64::from(index));
        value.serialize(self)
    }

    fn serialize_seq(self, length: Option<usize>) -> Result<Self, Never> {
        self.word(length.unwrap_or(0) as u64);
        Ok(self)
    }

    fn serialize_tuple(self, _: usize) -> Result<Self, Never> {
        Ok(self)
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, Never> {
        Ok(self)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, Never> {
        self.word(u64::from(index));
        Ok(self)
    }

    fn serialize_map(self, length: Option<usize>) -> Result<Self, Never> {
        self.word(length.unwrap_or(0) as u64);
        Ok(self)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self, Never> {
        Ok(self)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, Never> {
        self.word(u64::from(index));
        Ok(self)
    }
}

macro_rules! elements {
    ($($kind:ident: $name:ident),*) => { $(
        impl $kind for &mut Hasher {
            type Ok = ();
            type Error = Never;

            fn $name<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Never> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), Never> {
                Ok(())
            }
        }
    )* };
}

elements!(
    SerializeSeq: serialize_element,
    SerializeTuple: serialize_element,
    SerializeTupleStruct: serialize_field,
    SerializeTupleVariant: serialize_field
);

macro_rules! fields {
    ($($kind:ident),*) => { $(
        impl $kind for &mut Hasher {
            type Ok = ();
            type Error = Never;

            fn serialize_field<T: Serialize + ?Sized>(&mut self, _: &'static str, value: &T) -> Result<(), Never> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), Never> {
                Ok(())
            }
        }
    )* };
}

fields!(SerializeStruct, SerializeStructVariant);

impl SerializeMap for &mut Hasher {
    type Ok = ();
    type Error = Never;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Never> {
        key.serialize(&mut **self)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Never> {
        value.serialize(&mut **self)
    }

    fn end(self) -> Result<(), Never> {
        Ok(())
    }
}
