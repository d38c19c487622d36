//! Rocks, stones and logs fall on the giant, ride on it, and roll off when it shakes.
//!
//! `cargo run --release --example rocks -- --help` lists the options. The bench `debris` has the same scene.

mod checks;
mod scene;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::giant::giant;
use clamber_scenes::measure::checked;
use clap::Parser;

use checks::Outcome;
use scene::{CREATURE, Rocks, TICK};

/// Time in which rocks fall on the giant, seconds.
const FALL: f64 = 8.0;
/// Time in which the remaining rocks come to rest, seconds.
const SETTLE: f64 = 8.0;
/// Time that is added while a rock is still in the air, seconds, and the largest number of times that it is added.
const WAIT: (f64, u32) = (1.0, 8);

/// Largest depth of a settled rock in the skin, metres.
const DEEPEST: f64 = 0.02;

/// Number of ticks between two checks for rocks inside the giant.
const LOOK_EVERY: u32 = 10;

/// Rocks, stones and logs fall on the giant, ride on it, and roll off when it shakes.
///
/// Checks six times a second that no rock is inside the giant or under the ground, and at the end that none is more
/// than 2 cm deep in its skin. Prints a table, and exits with 1 if a check failed, and with 2 after an error.
#[derive(Parser)]
#[command(name = "rocks", version)]
struct Options {
    /// Number of rocks.
    #[arg(long, default_value_t = 60)]
    rocks: usize,

    /// Seconds for which the giant shakes, after eight in which the rocks fall.
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0)]
    shake: f64,

    /// Seed for the rocks' sizes and places; the same number gives the same result.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    checked("rocks", run(&Options::parse()))
}

fn run(options: &Options) -> Result<bool, Box<dyn Error>> {
    let giant = giant()?;
    let mut scene = Rocks::new(&giant, options.rocks, options.seed)?;
    let mut outcome = Outcome::default();
    let mut tick = 0;
    for (clip, seconds) in [("idle", FALL), ("shake", options.shake), ("idle", SETTLE)] {
        scene.play(Some(clip));
        play(&mut scene, seconds, &mut outcome, &mut tick)?;
        if clip == "idle" {
            outcome.settle(&scene);
            println!(
                "after {:.0} s: {} on the giant, {} in the valley",
                f64::from(tick) * TICK,
                outcome.on_giant,
                outcome.on_ground
            );
        }
    }
    for _ in 0..WAIT.1 {
        if outcome.all_lie() {
            break;
        }
        play(&mut scene, WAIT.0, &mut outcome, &mut tick)?;
        outcome.settle(&scene);
    }
    println!("{:.0} s of rocks on the giant", f64::from(tick) * TICK);
    print!("{outcome}");
    Ok(outcome.tunnelled == 0 && outcome.deepest <= DEEPEST && outcome.all_lie())
}

fn play(
    scene: &mut Rocks<'_>,
    seconds: f64,
    outcome: &mut Outcome,
    tick: &mut u32,
) -> Result<(), Box<dyn Error>> {
    for _ in 0..(seconds / TICK).round() as u32 {
        scene.pose()?;
        let skin = (CREATURE, &scene.surface);
        let report = scene.rocks.step(skin, &mut scene.world, TICK)?;
        outcome.put_back += report.put_back;
        outcome.caught += report.caught;
        *tick += 1;
        if tick.is_multiple_of(LOOK_EVERY) {
            outcome.look(scene);
        }
    }
    Ok(())
}
