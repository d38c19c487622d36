//! How do character controllers behave on moving ground? clamber's climber, on bodies and on skin, beside rapier's
//! `KinematicCharacterController` and, with the feature `jolt`, Jolt's `CharacterVirtual`.
//!
//! The bench plays the thirty scenes of `clamber_scenes::controllers`. All controllers get the same solids (boxes as
//! boxes, the rest as triangles), the same ticks, a capsule of radius 0.3 m with a padding of 2 cm, gravity of 9.81
//! m/s2, slopes up to 50 degrees, ground up to 0.5 m below, and steps of 0.4 m. A character comes to rest for a second.
//! Then all solids move, and the character's error is measured after each tick, relative to the solids at that time.
//!
//! The bound of the error is the scenario's bound, or the bound of its source if that is looser, but at least a
//! millimetre, which players do not see. The depth in a wall is counted from 0.3 m, so that every controller may use up
//! its 2 cm of padding. "In the air" is the controller's own report. A character that loses its footing fails if the
//! scene asks it to stand.
//!
//! Limits of the comparison:
//!
//! - The climber was developed against these scenarios, the others were not. Scenarios that the climber does not pass
//!   yet (`OPEN` in that table) are not among the scenes.
//! - The others compute in f32, and the climber's own state is f64. The scenes are small, so this matters little.
//! - Times cover only the character's part of a tick, without the world's step, which is different work for each
//!   engine. Each controller runs alone and warm.
//! - On skin, every solid is a surface of its own, which is expensive with thirty solids.
//! - No solid deforms, since the other controllers cannot follow one that does.
//!
//! `controller/rapier.rs` and `controller/jolt` describe how those controllers are used. Each gets the best of the
//! settings that were tried: the world stepped before or after, bodies moved by position or by velocity, the press
//! down, the nudge, the distance that it looks ahead.
//!
//! Prints a table, writes a table with a row for each scene and controller to `target/measure/controllers.csv`, and a
//! table of times, with their bound, to `controllers_times.csv`. Fails if the climber fails in a scene, or an error of
//! any controller is not finite.
//!
//! Run it with `cargo bench --manifest-path peers/Cargo.toml --bench controllers`, and `--features jolt` if CMake is
//! installed. With `-- --test` it runs briefly, with at most 600 ticks a scene.

mod controller;
mod report;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::controllers::{Outcome, all, play};
use clamber_scenes::measure::{exit_code, is_brief};
use report::Report;

/// Largest number of ticks of a scene in a brief run.
const BRIEF: u32 = 600;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let most = if brief { BRIEF } else { u32::MAX };
    let entries = controller::all();
    let mut report = Report::new(&entries);
    let mut wrong = Vec::new();
    for scene in all() {
        let outcomes = entries.iter().map(|entry| {
            let mut character = (entry.make)(&scene.set)?;
            play(&scene, character.as_mut(), most)
        });
        let outcomes: Vec<Outcome> = outcomes.collect::<Result<_, Box<dyn Error>>>()?;
        for (entry, outcome) in entries.iter().zip(&outcomes) {
            let fails = entry.is_ours && !outcome.passes;
            if fails || !outcome.error.is_finite() {
                wrong.push(format!("{}, {}", scene.name, entry.name));
            }
        }
        report.add(&scene, &outcomes);
    }
    report.finish(brief)?;
    if wrong.is_empty() {
        return Ok(());
    }
    Err(format!("failed, or not finite: {}", wrong.join("; ")).into())
}
