//! Hashes of every bit of battles with rapier: creature, climber, rocks. With the feature `deterministic` they are the
//! same in every build and on every platform. Golden tests without rapier are in `crates/clamber_climber/tests/golden`.
//!
//! `cargo test --release --features deterministic --test golden_battle`

use std::collections::BTreeSet;

use clamber::climber::ClimberMode;
use clamber_scenes::battle::{Battle, BattleOptions, CREATURE};
use clamber_scenes::giant::giant;

/// Hash of the battle. It changes with any bit of a result, and with rapier. Check that a change is intended, then
/// store the new hash.
const BATTLE: u64 = 0xf693_9554_6661_67f7;

/// Hash of the climb.
const CLIMB: u64 = 0xb919_164a_dcd1_3dbd;

#[test]
fn a_climb_has_the_same_bits_in_every_build() {
    let creature = giant().unwrap();
    let options = BattleOptions::default();
    let mut battle = Battle::new(&creature, &options).unwrap();
    let mut modes = BTreeSet::new();
    for tick in 0..2_400 {
        battle.step(options.input_at(tick)).unwrap();
        modes.insert(battle.climber().state().mode.number());
    }
    // Otherwise the hash would cover too little.
    assert!(modes.len() == ClimberMode::ALL.len(), "modes {modes:?}");
    let found = battle.recording().hash();
    assert!(found == CLIMB, "the hash is {found:#018x}");
}

#[test]
fn a_battle_has_the_same_bits_in_every_build() {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(24, 1);
    let mut battle = Battle::new(&creature, &options).unwrap();
    let mut carried = 0;
    for tick in 0..1_200 {
        battle.step(options.input_at(tick)).unwrap();
        let support = battle.climber().state().support;
        carried +=
            usize::from(support.is_some_and(|support| support.attachment.obstacle == CREATURE));
    }
    // Otherwise the hash would cover too little.
    assert!(carried > 600, "{carried} ticks on the creature");
    let found = battle.recording().hash();
    assert!(found == BATTLE, "the hash is {found:#018x}");
}
