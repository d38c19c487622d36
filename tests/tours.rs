//! Climbing tours from foot to head, on creatures that idle, walk and shake gently.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_scenes::tour::{Motion, Outcome, Stage, Ways, climb, config};
use clamber_scenes::{Creature, giant, test_data};

/// Height of the creatures, metres.
const HEIGHT: f64 = 20.0;

/// Makes tours with all motions, and checks them. `thrown` is the number of tours that may end early, thrown off a
/// swinging foot before the climber is on the leg.
fn tours(creature: &Creature, tempo: f64, seeds: u64, thrown: usize) {
    let ways = Ways::new(creature).unwrap();
    let mut failed = Vec::new();
    for motion in [Motion::Idle, Motion::Walk, Motion::Shake] {
        let mut outcomes: Vec<(u64, Outcome)> = Vec::new();
        for seed in (motion as u64..seeds).step_by(3) {
            let mut stage = Stage::new(creature, (HEIGHT, tempo), motion).unwrap();
            let route = ways.climb(seed).unwrap();
            let outcome = climb(&mut stage, &route, config(), 120.0).unwrap();
            outcomes.push((seed, outcome));
        }
        for (seed, outcome) in outcomes {
            println!("{} {motion:?} {seed}: {outcome:?}", creature.name);
            let good = outcome.arrived && outcome.falls == 0 && outcome.penetration <= 1e-3;
            if !good {
                failed.push((motion, seed, outcome));
            }
        }
    }
    let is_thrown = |(motion, _, outcome): &&(Motion, u64, Outcome)| {
        matches!(motion, Motion::Walk) && outcome.corners == 0
    };
    let early = failed.iter().filter(is_thrown).count();
    assert!(
        failed.len() == early && early <= thrown,
        "{}: {failed:#?}",
        creature.name
    );
}

#[test]
fn tours_reach_the_giants_head() {
    // The giant's soles do not slide, so its feet swing as fast as it walks: with 3 g.
    tours(&giant::giant().unwrap(), 1.0, 20, 1);
}

#[test]
fn tours_reach_the_heads_of_five_models() {
    for name in ["Trex", "Apatosaurus", "Triceratops", "Stag", "Bull"] {
        let Some(path) = test_data::file("tours", &format!("models/{name}.glb")) else {
            return;
        };
        // The clips were made for animals about two metres tall, or for robots, so they are slowed here.
        tours(&Creature::load(&path).unwrap(), 0.12, 20, 0);
    }
}
