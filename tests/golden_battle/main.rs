//! Hashes of every bit of battles with rapier: creature, climber, rocks. With the feature `deterministic` they are the
//! same in every build and on every platform. Golden tests without rapier are in `crates/clamber_climber/tests/golden`.
//!
//! `cargo test --release --features deterministic --test golden_battle`

use std::collections::BTreeSet;

use clamber::climber::ClimberMode;
use clamber::surface::palette_fingerprint;
use clamber_scenes::battle::{Battle, BattleOptions, CREATURE};
use clamber_scenes::giant::giant;
use clamber_verify::golden::{GoldenRun, hold};

/// Hash of the ride. It changes with any bit of a result, and with rapier's version. Check that a change is intended,
/// then store the new hash, and the file by `CLAMBER_BLESS=1`.
const RIDE: u64 = 0x84d9_e97f_179e_5c66;

/// Hash of the climb, under the same rules as [`RIDE`].
const CLIMB: u64 = 0x43e4_c44e_fc77_1420;

/// Adds a tick of a battle: the climber's fields, the creature's pose, the rocks and the fight.
fn add(run: &mut GoldenRun, battle: &Battle<'_>) {
    run.field("climber", battle.climber().state().fingerprint());
    run.fields("its ", battle.climber().state());
    run.field("creature", palette_fingerprint(battle.palette()));
    run.field("rocks", battle.rocks_fingerprint);
    run.field("rocks and fight", battle.scene_fingerprint());
    run.end_tick();
}

/// The path of a stored file beside this one.
fn stored(name: &str) -> String {
    format!(
        "{}/tests/golden_battle/{name}.golden",
        env!("CARGO_MANIFEST_DIR")
    )
}

#[test]
fn a_climb_has_the_same_bits_in_every_build() {
    let creature = giant().unwrap();
    let options = BattleOptions::default();
    let held = hold(stored("climb"), CLIMB, |run| {
        let mut battle = Battle::new(&creature, &options).unwrap();
        let mut modes = BTreeSet::new();
        for tick in 0..options.ticks() {
            battle.step(options.input_at(tick)).unwrap();
            modes.insert(battle.climber().state().mode.number());
            add(run, &battle);
        }
        // Otherwise the hash would cover too little.
        assert!(modes.len() == ClimberMode::ALL.len(), "modes {modes:?}");
    });
    held.unwrap();
}

#[test]
fn a_ride_has_the_same_bits_in_every_build() {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(24, 1);
    let held = hold(stored("ride"), RIDE, |run| {
        let mut battle = Battle::new(&creature, &options).unwrap();
        let mut carried = 0;
        for tick in 0..1_200 {
            battle.step(options.input_at(tick)).unwrap();
            let support = battle.climber().state().support;
            carried +=
                usize::from(support.is_some_and(|support| support.attachment.obstacle == CREATURE));
            add(run, &battle);
        }
        // Otherwise the hash would cover too little.
        assert!(carried > 600, "{carried} ticks on the creature");
    });
    held.unwrap();
}
