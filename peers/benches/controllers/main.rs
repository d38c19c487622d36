//! How do character controllers fare on ground that moves? clamber's climber, on bodies and on skin, beside rapier's
//! `KinematicCharacterController` and, with the feature `jolt`, Jolt's `CharacterVirtual`.
//!
//! The thirty scenes are those of `clamber_scenes::controllers`. All of the controllers
//! get the same solids, boxes as boxes and the rest as triangles, the same ticks, a capsule of radius 0.3 m with 2 cm about
//! it, gravity of 9.81 m/s2, slopes to 50 degrees, a reach of 0.5 m down and steps of 0.4 m. Each comes to rest for a
//! second; then everything moves, and what is asked of it is measured after each tick, against where things are then.
//!
//! Asked is what the scenario asks, or its source where that is looser, or a millimetre where either is finer: nobody
//! sees one. The depth in a wall is counted from 0.3 m, so that the 2 cm are everybody's to give way. "In the air" is what a
//! controller says of itself; who loses its footing fails where the scenario asks to stand.
//!
//! What the numbers are not: the climber was made with these scenarios at hand, the others were not; of the scenarios that
//! it does not hold yet (`OPEN` in that table) none is here. The others compute in f32, and the climber's own state is f64;
//! scenes are small, so that this matters little. Times are of the character's part of a tick alone, without the world's
//! step, which is other work in each; each controller runs by itself, warm. On skin every solid is a surface of its own,
//! which costs where there are thirty. Nothing here deforms, which the others have no way to be told.
//!
//! `controller/rapier.rs` and `controller/jolt` say how theirs are used. Each is given what helped it most of what was
//! tried: the world stepped before or after, bodies moved by position or by velocity, what presses it down, what it is
//! nudged off by, how far it looks.
//!
//! Prints a table, and writes one with a row for each scene and controller to `target/measure/controllers.csv`. Fails if
//! one of ours fails in a scene, or a number is none.
//!
//! `cargo bench --manifest-path peers/Cargo.toml --bench controllers`, with `--features jolt` once there is CMake; brief, with 600 ticks a
//! scene at most, with `-- --test`.

mod controller;
mod report;

use std::error::Error;
use std::process::ExitCode;

use clamber_scenes::controllers::{Outcome, all, play};
use clamber_scenes::measure::is_brief;
use report::Report;

/// Ticks of a scene in a brief run, at most.
const BRIEF: u32 = 600;

fn main() -> ExitCode {
    match run(is_brief()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
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
        report.add(&scene, &entries, &outcomes);
    }
    report.finish(brief)?;
    if wrong.is_empty() {
        return Ok(());
    }
    Err(format!("not as it has to be: {}", wrong.join("; ")).into())
}
