//! A climber fights a giant that hunts it and shakes it off, from the ground to its head, while rocks fall.
//!
//! `cargo run --release --example battle -- --help` lists the options. The scene and its checks are in
//! `clamber_scenes::battle`. The example films with `--features render`, and records with `--features record`.

mod fights;
#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
mod film;
mod options;
mod report;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::process::ExitCode;

use clamber_scenes::battle::{Battle, TICK, Watch};
use clamber_scenes::measure::checked;
use options::Options;
use report::Sums;

type Failure = Box<dyn Error>;

/// A film or a recording of a battle.
trait Camera {
    /// Takes in the battle's current tick.
    fn watch(&mut self, battle: &Battle<'_>) -> Result<(), Failure>;

    /// Ends the film or the recording.
    fn finish(self: Box<Self>) -> Result<(), Failure> {
        Ok(())
    }
}

fn main() -> ExitCode {
    let options = Options::from_command_line();
    let all_hold = match options.fights {
        Some(count) => fights::fight_all(&options.battle, count),
        None => run(&options),
    };
    checked("battle", all_hold)
}

/// Fights a battle, films and records it, and reports the results. Returns true if all checks hold.
fn run(options: &Options) -> Result<bool, Failure> {
    let settings = &options.battle;
    let summary = open(&options.out.join("summary.json"))?;
    let file = options.record.as_deref().map(open).transpose()?;
    let mut cameras = Vec::new();
    if options.film.is_wanted() {
        cameras.push(film(options)?);
    }
    let creature = settings.load_creature()?;
    let mut battle = Battle::new(&creature, settings)?;
    let (mut watch, mut sums) = (Watch::default(), Sums::default());
    if let Some(file) = file {
        cameras.push(recorder(file, &battle, options)?);
    }
    for tick in 0..=settings.ticks() {
        if tick > 0 {
            battle.step(settings.input_at(tick - 1))?;
            watch.tick(&battle);
            sums.add(&battle);
        }
        for camera in &mut cameras {
            camera.watch(&battle)?;
        }
        if tick % 600 == 0 {
            let state = battle.climber().state();
            let (seconds, height) = (tick as f64 * TICK, state.position.y);
            eprintln!("{seconds:5.1} s  {height:5.1} m up  {:?}", state.mode);
        }
    }
    for camera in cameras {
        camera.finish()?;
    }
    let checks = watch.checks(&battle, settings);
    report::write(&battle, &checks, empty(summary)?)?;
    print!("{}", report::table(&battle, &watch, &sums, &checks));
    Ok(checks.iter().all(|check| check.holds()))
}

/// Opens a file for the results, which keeps its content until there are new ones.
fn open(path: &Path) -> Result<File, Failure> {
    let failed = |error| format!("cannot write {}: {error}", path.display());
    std::fs::create_dir_all(path.parent().unwrap_or(path)).map_err(failed)?;
    let mut how = File::options();
    let how = how.write(true).create(true).truncate(false);
    Ok(how.open(path).map_err(failed)?)
}

fn empty(file: File) -> Result<BufWriter<File>, Failure> {
    file.set_len(0)?;
    Ok(BufWriter::new(file))
}

#[cfg(all(feature = "render", feature = "gltf", feature = "rapier"))]
fn film(options: &Options) -> Result<Box<dyn Camera>, Failure> {
    Ok(Box::new(film::Film::new(&options.battle, &options.film)?))
}

#[cfg(not(all(feature = "render", feature = "gltf", feature = "rapier")))]
fn film(_: &Options) -> Result<Box<dyn Camera>, Failure> {
    Err("built without rendering: add `--features render` to the command, before `--`".into())
}

#[cfg(feature = "record")]
impl Camera for clamber_scenes::battle::BattleRecorder<BufWriter<File>> {
    fn watch(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        self.tick(battle)
    }

    fn finish(self: Box<Self>) -> Result<(), Failure> {
        (*self).finish()?;
        Ok(())
    }
}

#[cfg(feature = "record")]
fn recorder(
    file: File,
    battle: &Battle<'_>,
    options: &Options,
) -> Result<Box<dyn Camera>, Failure> {
    let how = clamber::record::RecordOptions::waiting();
    let recorder =
        clamber_scenes::battle::BattleRecorder::new(empty(file)?, battle, &options.battle, how)?;
    let hero = clamber_scenes::hero::Hero::load()?;
    Ok(Box::new(recorder.with_hero(hero)))
}

#[cfg(not(feature = "record"))]
fn recorder(_: File, _: &Battle<'_>, _: &Options) -> Result<Box<dyn Camera>, Failure> {
    Err("this build cannot record: add --features record to cargo's arguments".into())
}
