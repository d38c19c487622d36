//! A climber rides every model of a folder for a minute, as `battle --story ride --creature FILE` does, and a table
//! shows which checks hold on creatures that were not made for this project.
//!
//! `cargo run --release --example rides -- --help` lists the options.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clamber_scenes::battle::{
    Battle, BattleOptions, Check, DRIFT, FALLS, INSIDE, PUSHED_OFF, ROCKS_INSIDE, STANDS_OFF,
    SceneError, Watch, positive,
};
use clamber_scenes::measure::checked;
use clamber_scenes::{Creature, test_data};
use clap::Parser;

/// A climber rides every model of a folder for a minute, and a table shows which checks hold.
///
/// Below the table, each failed check is listed with the place and time of its first failure. Exits with 1 if a model
/// that can be loaded fails a check, or if none can be loaded, and with 2 after an error.
#[derive(Clone, Debug, Parser)]
#[command(name = "rides", version)]
struct Options {
    /// Models in .glb or .gltf files [default: all files of models/ in the folder that CLAMBER_TEST_DATA names].
    #[arg(value_name = "FILE")]
    models: Vec<PathBuf>,

    /// Height of every creature, metres.
    #[arg(long, value_name = "METRES", default_value_t = 20.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    height: f64,

    /// Length of every ride.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    seconds: f64,

    /// Number of rocks that fall on every creature.
    #[arg(long, value_name = "COUNT", default_value_t = 24)]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=1000))]
    rocks: u32,

    /// Seed for the climber's start and the rocks' places; the same number gives the same rides.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    checked("rides", run(&Options::parse()))
}

/// Rides all models and prints the table; true if no model that can be loaded fails a check.
fn run(options: &Options) -> Result<bool, SceneError> {
    let files = test_data::models_or(&options.models)?;
    println!(
        "| model | riding | standing | falls | drift, mm | pushed off, mm | stands off, mm | inside | rocks inside | \
         rocks left | |\n|---|---|---|---|---|---|---|---|---|---|---|"
    );
    let (mut ridden, mut held, mut causes) = (0, 0, String::new());
    for file in &files {
        let model = file.file_stem().unwrap_or_default().to_string_lossy();
        match ride(file, options) {
            Err(error) => println!("| {model} | | | | | | | | | | refused: {error} |"),
            Ok((cells, failed)) => {
                let names: Vec<&str> = failed.iter().map(|check| check.name).collect();
                let verdict = match names.join("; ") {
                    none if none.is_empty() => "ok".to_owned(),
                    names => format!("fails: {names}"),
                };
                println!("| {model} | {cells} | {verdict} |");
                ridden += 1;
                held += usize::from(failed.is_empty());
                for check in &failed {
                    let cause = check.cause.as_deref().unwrap_or("no cause recorded");
                    causes += &format!("{model}: {}: {cause}\n", check.name);
                }
            }
        }
    }
    println!("\n{held} of {ridden} models pass all checks\n\n{causes}");
    Ok(held == ridden && ridden > 0)
}

/// Rides a model. Returns its cells of the table, and the checks that fail.
fn ride(file: &Path, options: &Options) -> Result<(String, Vec<Check>), SceneError> {
    let creature = Creature::load(file)?;
    let settings = BattleOptions {
        creature: Some(file.to_owned()),
        height: Some(options.height),
        seconds: Some(options.seconds),
        ..BattleOptions::ride(options.rocks, options.seed)
    };
    let mut battle = Battle::new(&creature, &settings)?;
    let mut watch = Watch::default();
    for tick in 0..settings.ticks() {
        battle.step(settings.input_at(tick))?;
        watch.tick(&battle);
    }
    let mut checks = watch.checks(&battle, &settings);
    checks.retain(|check| !check.holds());
    let [standing, ..] = watch.modes;
    let cells = format!(
        "{:.1} % | {:.1} % | {} | {:.4} | {:.1} | {:.1} | {} | {} | {}",
        watch.riding_share() * 100.0,
        standing as f64 / watch.ticks().max(1) as f64 * 100.0,
        watch.found(FALLS),
        watch.found(DRIFT) * 1e3,
        watch.found(PUSHED_OFF) * 1e3,
        watch.found(STANDS_OFF) * 1e3,
        watch.found(INSIDE),
        watch.found(ROCKS_INSIDE),
        battle.rocks.left,
    );
    Ok((cells, checks))
}
