//! A creature that falls asleep stops where it is, and continues when it wakes.

use crate::support::{brain_with, creature, kind, level_ground, on_terrain};
use clamber_colossus::{Creature, CreatureConfig};

/// Steps a creature for some ticks. Returns the times of the layers of its clips.
fn live(one: &mut Creature, ticks: u32) -> Vec<f64> {
    let terrain = level_ground();
    for _ in 0..ticks {
        one.step(&on_terrain(&terrain)).unwrap();
    }
    let layers = one.state().animator().layers().iter();
    layers.map(|layer| layer.time).collect()
}

/// All clips stop in sleep, whether the creature stood, played a clip or walked before. When it wakes, all of them
/// continue, with or without an act in the new state.
#[test]
fn clips_stop_in_sleep_and_go_on_after_it() {
    let states = r#"{
        "stands": {},
        "plays": { "act": { "play": "roar" } },
        "walks": { "act": { "walk": { "to": "patrol", "within": 1 } } },
        "sleeps": { "act": "sleep" }
    }"#;
    let kind = kind(&brain_with("stands", states));
    for before in ["stands", "plays", "walks"] {
        for after in ["stands", "plays", "walks"] {
            let mut one = creature(&kind, CreatureConfig::default());
            assert!(one.enter(before));
            live(&mut one, 100);
            assert!(one.enter("sleeps"));
            // A fade or a walk comes to its end first.
            let at = live(&mut one, if before == "stands" { 2 } else { 200 });
            assert_eq!(live(&mut one, 30), at, "from {before}");
            let layers = one.state().animator().layers();
            assert!(layers.len() > 1, "it breathes");
            live(&mut one, 200);
            assert!(one.enter(after));
            let from = live(&mut one, 2);
            let later = live(&mut one, 20);
            for (index, (from, later)) in from.iter().zip(&later).enumerate() {
                assert_ne!(from, later, "layer {index}, from {before} to {after}");
            }
        }
    }
}
