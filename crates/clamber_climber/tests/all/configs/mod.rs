//! Random configurations: every one that is accepted works. Climbers walk, jump, climb and pull themselves up at the
//! speeds that their configuration names, and without input they come to rest.

mod plays;
mod random;

use clamber_climber::{Climber, ClimberConfig};
use glam::DVec3;

/// A play with a configuration; an error tells the failure.
type Play = fn(&ClimberConfig) -> Result<(), String>;

/// All plays, by name.
const PLAYS: [(&str, Play); 10] = [
    ("drops and stands", plays::drops_and_stands),
    ("walks", plays::walks),
    ("jumps", plays::jumps),
    ("falls from high", plays::falls_from_high),
    ("slides down a slope", plays::slides_down),
    ("is knocked over", plays::is_knocked_over),
    ("climbs a wall", plays::climbs),
    ("lets go", plays::lets_go),
    ("hangs from a ledge", plays::hangs),
    ("pulls itself up", plays::pulls_up),
];

fn play(seeds: std::ops::Range<u64>) {
    let mut wrong = Vec::new();
    let mut accepted = 0;
    for seed in seeds {
        let config = random::config(&mut fastrand::Rng::with_seed(seed));
        if Climber::new(config, DVec3::ZERO).is_err() {
            continue;
        }
        accepted += 1;
        for (name, play) in PLAYS {
            if let Err(reason) = play(&config) {
                wrong.push(format!("seed {seed}: {name}: {reason}"));
            }
        }
    }
    println!("{accepted} configurations");
    let first = wrong
        .iter()
        .take(12)
        .cloned()
        .collect::<Vec<_>>()
        .join("\n");
    assert!(wrong.is_empty(), "{} of {accepted}:\n{first}", wrong.len());
    assert!(accepted > 0);
}

#[test]
fn two_thousand_accepted_configurations_work() {
    play(0..2000);
}
