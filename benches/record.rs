//! Measures the cost of recording a battle, and the size of the file.
//!
//! Two battles with the same options take turns, tick by tick: one is recorded to a file, the other is not. A tick
//! consists of pose, climber and rocks. Prints a table and writes it to
//! `target/measure/record.csv`: name, value, bound, holds. Fails if the two battles differ.
//!
//! Run it with `cargo bench -p clamber_benches --features record --bench record`; briefly with `-- --test`.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::process::ExitCode;
use std::time::Instant;

use clamber::record::{RecordOptions, Recorder, RecordingInfo, TickView};
use clamber_scenes::battle::{Battle, BattleOptions, BattleRecorder, TICK};
use clamber_scenes::giant::giant;
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut cells = Cells::default();
    // The first megabytes that a machine writes to its file cache may cost ten times as much as later ones.
    let warm = std::env::temp_dir().join(format!("clamber-warm-{}", std::process::id()));
    std::fs::write(&warm, vec![1; 40_000_000])?;
    std::fs::remove_file(&warm)?;
    let no_views = RecordOptions {
        transforms_every: 0,
        skin_every: 0,
        ..RecordOptions::waiting()
    };
    for rocks in [24, 0] {
        let name = format!("{rocks} rocks");
        measure(&name, rocks, RecordOptions::waiting(), brief, &mut cells)?;
        let name = format!("{rocks} rocks, only the data for a replay");
        measure(&name, rocks, no_views, brief, &mut cells)?;
    }
    cells.finish("record", brief)
}

fn measure(
    name: &str,
    rocks: u32,
    how: RecordOptions,
    brief: bool,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let creature = giant()?;
    let options = BattleOptions::ride(rocks, 1);
    let battle = || Battle::new(&creature, &options);
    let (mut plain, mut recorded) = (battle()?, battle()?);
    let path = std::env::temp_dir().join(format!("clamber-record-{}.mcap", std::process::id()));
    let file = BufWriter::new(File::create(&path)?);
    let mut recorder = BattleRecorder::new(file, &recorded, &options, how)?;
    let ticks = if brief { 120 } else { 3600 };
    let mut costs = Vec::new();
    recorder.tick(&recorded)?;
    for tick in 0..ticks {
        let intent = options.input_at(tick);
        // The order alternates, since the second battle finds warm caches.
        if tick.is_multiple_of(2) {
            plain.step(intent)?;
            recorded.step(intent)?;
        } else {
            recorded.step(intent)?;
            plain.step(intent)?;
        }
        let start = Instant::now();
        recorder.tick(&recorded)?;
        costs.push(start.elapsed().as_secs_f64() * 1e6);
    }
    recorder.finish()?;
    let bytes = std::fs::metadata(&path)?.len() as f64;
    std::fs::remove_file(&path)?;
    if plain.hash() != recorded.hash() {
        return Err("the recorded battle differs from the one that was not recorded".into());
    }
    let (without, beside) = (tick_us(&plain), tick_us(&recorded));
    let recording = mean(&costs);
    let mut rows = cells.of(name);
    rows.value("a tick, us, mean", without);
    rows.value("a recorded tick, us, mean", beside + recording);
    rows.value("of that, recording", recording);
    // Ticks are grouped by the rarest record that is due in them. A tick's time includes the more frequent records that
    // are due in it as well.
    let kinds = [
        ("state and input only", 1, 4),
        ("with joints, skin and rocks", 4, 60),
        ("with a chunk to write", 60, u64::MAX),
    ];
    let viewed = how.skin_every > 0;
    for (what, every, but) in kinds.into_iter().filter(|_| viewed) {
        let due = (1..).zip(&costs).filter(|(tick, _)| {
            u64::is_multiple_of(*tick, every) && !u64::is_multiple_of(*tick, but)
        });
        let mut due: Vec<f64> = due.map(|(_, cost)| *cost).collect();
        let median = quantile(&mut due, 0.5);
        rows.value(&format!("recording, us, median, {what}"), median);
    }
    let written = writer_us(&recorded, &options, how, ticks)?;
    rows.value("writing the same tick repeatedly, us a tick", written);
    let share = recording / without;
    rows.push("recording / a tick", share, Bound::Most(0.05));
    let minute = bytes * 3600.0 / ticks as f64 / 1e6;
    rows.push("MB a minute", minute, Bound::Most(50.0));
    Ok(())
}

/// The writing thread's time for a tick, microseconds: records the battle's last tick repeatedly, so that the game only
/// copies it and waits.
fn writer_us(
    battle: &Battle<'_>,
    options: &BattleOptions,
    how: RecordOptions,
    ticks: u64,
) -> Result<f64, Box<dyn Error>> {
    let info = RecordingInfo {
        creature: battle.creature.name.clone(),
        creature_fingerprint: 0,
        tick_seconds: TICK,
        climber: *battle.climber().config(),
        settings: options.to_settings(),
        version: RecordingInfo::VERSION.to_owned(),
    };
    let skeleton = &battle.creature.rig.skeleton;
    let path = std::env::temp_dir().join(format!("clamber-writer-{}.mcap", std::process::id()));
    let mut recorder = Recorder::create(&path, &info, skeleton, how)?;
    let snapshot = battle.snapshot();
    let start = Instant::now();
    for tick in 0..ticks {
        recorder.tick(&TickView {
            tick,
            input: &battle.input,
            knockback: None,
            state: battle.climber().state(),
            report: battle.report(),
            surface: battle.surface(),
            palette: battle.palette(),
            scene_fingerprint: 0,
        })?;
        if tick.is_multiple_of(60) {
            let snapshot = snapshot.clone();
            recorder.snapshot_with(move || serde_json::to_string(&snapshot))?;
        }
    }
    recorder.finish()?;
    let all = start.elapsed().as_secs_f64();
    std::fs::remove_file(&path)?;
    Ok(all * 1e6 / ticks as f64)
}

/// Mean time of a tick, microseconds: pose, climber and rocks.
fn tick_us(battle: &Battle<'_>) -> f64 {
    let times: Vec<f64> = battle
        .times
        .iter()
        .map(|[own, rocks]| own + rocks)
        .collect();
    mean(&times)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
