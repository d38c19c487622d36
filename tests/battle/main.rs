//! Battles pass their checks, each check fails on its own fault and on no other, and rocks, riders and climbers that
//! get lost are brought back.

#![allow(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod checks;
mod climb;
mod options;
mod proposed;
mod repeat;
mod ride;
mod scene;

use clamber_scenes::Creature;
use clamber_scenes::battle::{Battle, BattleOptions, Check, Watch};

/// Runs a battle to its end, and checks every tick.
fn fight<'a>(creature: &'a Creature, options: &BattleOptions) -> (Battle<'a>, Watch) {
    let mut battle = Battle::new(creature, options).unwrap();
    let mut watch = Watch::default();
    for tick in 0..options.ticks() {
        battle.step(options.input_at(tick)).unwrap();
        watch.tick(&battle);
    }
    (battle, watch)
}

/// The checks that fail, as text.
fn failed(battle: &Battle<'_>, watch: &Watch, options: &BattleOptions) -> String {
    let checks = watch.checks(battle, options);
    let failed = checks.iter().filter(|check| !check.holds());
    failed.map(Check::to_string).collect::<Vec<_>>().join("\n")
}
