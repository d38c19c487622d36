//! Fights a recorded battle again and compares every tick, bit for bit.
//!
//! `cargo run --release --features record --example battle -- --record target/battle.mcap`, then
//! `cargo run --release --features record --example replay -- target/battle.mcap`. With `--from TICK` it
//! starts from the nearest snapshot at or before that tick. Exits with 1 if a tick differs, with 2 if there is
//! nothing to replay.

use std::path::PathBuf;
use std::process::ExitCode;

use clamber::record::{Ending, Recording};
use clamber_scenes::battle;

const USAGE: &str = "usage: replay FILE.mcap [--from TICK]";

fn main() -> ExitCode {
    match run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!("replay: {error}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let Some(Arguments { path, from }) = Arguments::read(std::env::args().skip(1))? else {
        println!("{USAGE}");
        return Ok(ExitCode::SUCCESS);
    };
    let recording = Recording::open(&path)?;
    let (info, ticks) = (recording.info(), recording.len());
    let seconds = ticks.saturating_sub(1) as f64 * info.tick_seconds;
    println!(
        "{}: {}, {ticks} ticks ({seconds:.1} s), written by version {}",
        path.display(),
        info.creature,
        info.version
    );
    if *recording.ending() != Ending::Whole {
        println!("{}, read {ticks} ticks", recording.ending());
    }
    if recording.is_empty() {
        return Err("no tick to replay".into());
    }
    let replay = battle::replay(&recording, from)?;
    if let Some(difference) = &replay.difference {
        eprint!("{difference}");
        eprintln!("replay: FAILED after {} ticks that agree", replay.agreed);
        return Ok(ExitCode::FAILURE);
    }
    let compared = if replay.with_rocks {
        "climber, creature and rocks"
    } else {
        "climber and creature (no snapshot holds the rocks)"
    };
    println!(
        "replay: all {} ticks from tick {} on agree in every bit of {compared}",
        replay.agreed, replay.from
    );
    Ok(ExitCode::SUCCESS)
}

/// What the command line asks for.
struct Arguments {
    path: PathBuf,
    from: Option<u64>,
}

impl Arguments {
    /// `None` for help.
    fn read(mut given: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let (mut path, mut from) = (None, None);
        while let Some(argument) = given.next() {
            match argument.as_str() {
                "--help" | "-h" => return Ok(None),
                "--from" => {
                    let tick = given.next().ok_or(USAGE)?;
                    let parsed = tick.parse();
                    from = Some(parsed.map_err(|error| format!("--from {tick}: {error}"))?);
                }
                _ if path.is_none() && !argument.starts_with('-') => {
                    path = Some(PathBuf::from(argument));
                }
                other => return Err(format!("{other} is not expected; {USAGE}")),
            }
        }
        let path = path.ok_or(USAGE)?;
        Ok(Some(Self { path, from }))
    }
}
