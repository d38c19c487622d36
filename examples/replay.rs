//! Simulates a recorded battle or duel again, and compares every tick bit for bit.
//!
//! `cargo run --release --features record --example battle -- --record target/battle.mcap`, then
//! `cargo run --release --features record --example replay -- target/battle.mcap`. With `--from TICK` it
//! starts from the nearest snapshot at or before that tick. Exits with 1 if a tick differs, with 2 if there is
//! nothing to replay.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clamber::record::{AnyRecording, ArenaRecording, Ending};
use clamber_scenes::{battle, duel};
use clap::Parser;

/// Simulates a recorded battle or duel again, and compares every tick bit for bit.
///
/// Exits with 1 if a tick differs, with 2 if there is nothing to replay.
#[derive(Debug, Parser)]
#[command(name = "replay", version)]
struct Options {
    /// The recording that `battle --record FILE` or `duel --record FILE` wrote.
    #[arg(value_name = "FILE.mcap")]
    path: PathBuf,

    /// Starts from the nearest snapshot at or before this tick, without the rocks.
    #[arg(long, value_name = "TICK")]
    from: Option<u64>,
}

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
    let Options { path, from } = Options::parse();
    let recording = match AnyRecording::open(&path)? {
        AnyRecording::Climber(recording) => *recording,
        AnyRecording::Arena(recording) => return arena(&path, &recording, from),
    };
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

/// Replays the recording of an arena.
fn arena(
    path: &Path,
    recording: &ArenaRecording,
    from: Option<u64>,
) -> Result<ExitCode, Box<dyn std::error::Error>> {
    let (info, ticks) = (recording.info(), recording.len());
    println!(
        "{}: {} against {}, {ticks} ticks, written by version {}",
        path.display(),
        info.fighters.join(" and "),
        info.creatures.join(" and "),
        info.version
    );
    if *recording.ending() != Ending::Whole {
        println!("{}, read {ticks} ticks", recording.ending());
    }
    let replay = duel::replay(recording, from)?;
    if let Some(difference) = &replay.difference {
        eprintln!("{difference}");
        eprintln!("replay: FAILED after {} ticks that agree", replay.agreed);
        return Ok(ExitCode::FAILURE);
    }
    println!(
        "replay: all {} ticks from tick {} on agree in every bit of climbers, creatures and arrows",
        replay.agreed, replay.from
    );
    Ok(ExitCode::SUCCESS)
}
