//! A bot climbs many models to the highest place that their graphs call reachable.
//!
//! `cargo run --release --example climbs -- --help` lists the options. `bot.rs` makes one climb.

mod bot;
mod stage;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clamber::climber::ClimberConfig;
use clamber_scenes::measure::checked;
use clamber_scenes::{Creature, test_data};
use clap::Parser;

use bot::{ClimbOptions, Climbed, climb_by};

/// Least share of the models that the bot has to climb: 20 of 27.
const ENOUGH: f64 = 0.74;

/// A bot climbs every model of a folder, from the ground to the highest place that the model's graph calls reachable
/// with the strength that the bot counts on, and a table shows how long it takes.
///
/// All skin can be gripped, as if it were fur. Exits with 1 if the bot does not come there on 20 of 27 models, and with
/// 2 after an error.
#[derive(Parser)]
#[command(name = "climbs", version)]
struct Options {
    /// Models in .glb or .gltf files [default: all files of models/ in the folder that CLAMBER_TEST_DATA names].
    #[arg(value_name = "FILE")]
    models: Vec<PathBuf>,

    #[command(flatten)]
    climb: ClimbOptions,
}

fn main() -> ExitCode {
    checked("climbs", run(Options::parse()))
}

/// Climbs all models and prints the table; true if the bot came to the top of enough models.
fn run(Options { models, climb }: Options) -> Result<bool, Box<dyn Error>> {
    let files = test_data::models_or(&models)?;
    let mut rows = String::new();
    let mut climbs = Vec::new();
    for (index, file) in files.iter().enumerate() {
        let model = file.file_stem().unwrap_or_default().to_string_lossy();
        let verdict = match climb_file(file, &climb) {
            Err(error) => {
                rows += &format!("| {model} | refused: {error} |\n");
                "refused"
            }
            Ok(climbed) => {
                rows += &row(&model, &climbed);
                let verdict = match &climbed {
                    Climbed { times, .. } if times[1].is_some() => "there",
                    Climbed { top: 0.0, .. } => "cannot be got onto",
                    _ => "did not come there",
                };
                climbs.push(climbed);
                verdict
            }
        };
        let (done, of) = (index + 1, files.len());
        eprintln!("{done:3} of {of}  {model:<30} {verdict}");
    }
    let loaded = climbs.len();
    let there = climbs.iter().filter(|climb| climb.times[1].is_some());
    let there = there.count();
    let none = climbs.iter().filter(|climb| climb.top == 0.0).count();
    println!(
        "| model | patches | reachable | highest, m | least, s | got on, s | there, s | of the least | came up to, m | plans | falls |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n\
         {rows}\n\
         the bot comes to the highest reachable place of {there} of {loaded} models; {none} cannot be got onto\n"
    );
    Ok(loaded > 0 && there as f64 >= ENOUGH * loaded as f64)
}

fn climb_file(file: &Path, options: &ClimbOptions) -> Result<Climbed, Box<dyn Error>> {
    let creature = Creature::load(file)?;
    climb_by(ClimberConfig::colossus_climber(), &creature, options)
}

/// A row of the Markdown table.
fn row(model: &str, climbed: &Climbed) -> String {
    let number = |number: Option<f64>, digits: usize| {
        number.map_or_else(|| "-".to_owned(), |number| format!("{number:.digits$}"))
    };
    format!(
        "| {model} | {} | {:.1} % | {:.1} | {:.1} | {} | {} | {} | {:.1} | {} | {} |\n",
        climbed.patches,
        100.0 * climbed.reachable,
        climbed.top,
        climbed.least,
        number(climbed.times[0], 1),
        number(climbed.times[1], 1),
        number(climbed.ratio(), 2),
        climbed.highest,
        climbed.plans,
        climbed.falls,
    )
}
