//! Who falls asleep stops where it is, and goes on when it wakes.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{brain_with, creature, kind};
use clamber_colossus::{Creature, CreatureConfig, Surroundings};
use clamber_world::{HalfSpace, Obstacle};

/// Steps it for so many ticks, and says at which times the layers of its clips are.
fn live(one: &mut Creature, ticks: u32) -> Vec<f64> {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    for _ in 0..ticks {
        let around = Surroundings {
            terrain: &terrain,
            ..Surroundings::default()
        };
        one.step(&around).unwrap();
    }
    let layers = one.state().animator().layers().iter();
    layers.map(|layer| layer.time).collect()
}

/// From standing, from a clip, and from a walk: nothing of it moves on once it sleeps; and when it wakes to a state
/// without an act, and to one with a clip, all of it does.
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
            // What fades or walks comes to an end first.
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
