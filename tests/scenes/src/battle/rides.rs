//! Rides on many models, one after another, and a table of their results.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Parser;

use super::options::{Progress, positive};
use super::{BattleError, BattleOptions, ModeTicks, Story, Summary, fight};
use crate::test_data;

/// A climber rides every model of a folder for a minute, as `battle --story ride --creature FILE` does, and a table
/// shows which checks hold.
///
/// Below the table, each failed check is listed with the place and time of its first failure. Exits with 1 if a model
/// that can be loaded fails a check.
#[derive(Clone, Debug, Parser)]
#[command(name = "rides", version)]
pub struct RidesOptions {
    /// Models in .glb or .gltf files [default: all files of models/ in the folder that CLAMBER_TEST_DATA names].
    #[arg(value_name = "FILE")]
    pub models: Vec<PathBuf>,

    /// Height of every creature.
    #[arg(long, value_name = "METRES", default_value_t = 20.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub height: f64,

    /// Length of every ride.
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub seconds: f64,

    /// Number of rocks that fall on every creature.
    #[arg(long, value_name = "COUNT", default_value_t = 24)]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub rocks: u32,

    /// Seed for the climber's start and the rocks' places; the same number gives the same rides.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,

    /// Folder for the results: one folder per model, with summary.json and timeline.svg.
    #[arg(long, value_name = "DIR", default_value = "target/rides")]
    pub out: PathBuf,
}

/// One model's ride.
#[derive(Debug)]
pub struct Ride {
    /// The file's name, without its extension.
    pub model: String,
    /// The summary of the ride, or the reason why there was none.
    pub outcome: Result<Summary, BattleError>,
}

impl Ride {
    /// True if the model was ridden and every check holds.
    pub fn holds(&self) -> bool {
        self.outcome.as_ref().is_ok_and(Summary::holds)
    }
}

impl Default for RidesOptions {
    fn default() -> Self {
        Self::parse_from(["rides"])
    }
}

impl RidesOptions {
    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }

    /// The models' files: those of the options, in their order, or all of the default folder, sorted.
    ///
    /// # Errors
    /// [`BattleError::NoModels`] if the options name no file, and the default folder is not set, cannot be read, or has
    /// no model.
    pub fn files(&self) -> Result<Vec<PathBuf>, BattleError> {
        if !self.models.is_empty() {
            return Ok(self.models.clone());
        }
        let variable = test_data::VARIABLE;
        let root = std::env::var_os(variable).ok_or_else(|| {
            BattleError::NoModels(format!("pass files, or set {variable} to a folder"))
        })?;
        let folder = PathBuf::from(root).join("models");
        let failed =
            |e: std::io::Error| BattleError::NoModels(format!("{}: {e}", folder.display()));
        let mut files = Vec::new();
        for entry in std::fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.extension().is_some_and(|e| e == "glb" || e == "gltf") {
                files.push(path);
            }
        }
        files.sort();
        if files.is_empty() {
            let none = format!("no .glb or .gltf file in {}", folder.display());
            return Err(BattleError::NoModels(none));
        }
        Ok(files)
    }

    fn battle(&self, file: &Path, model: &str) -> BattleOptions {
        BattleOptions {
            creature: Some(file.to_owned()),
            brain: None,
            height: Some(self.height),
            story: Some(Story::Ride),
            seconds: Some(self.seconds),
            rocks: self.rocks,
            seed: self.seed,
            out: self.out.join(model),
            record: None,
            ..BattleOptions::default()
        }
    }
}

/// Rides every model. Calls `watch` after each ride, with the number of rides done and of all rides.
///
/// # Errors
/// [`BattleError::NoModels`]. A model that cannot be ridden is listed among the rides with its error.
pub fn ride_all(
    options: &RidesOptions,
    mut watch: impl FnMut(&Ride, usize, usize),
) -> Result<Vec<Ride>, BattleError> {
    let files = options.files()?;
    let mut rides = Vec::with_capacity(files.len());
    for file in &files {
        let model = file.file_stem().unwrap_or_default();
        let model = model.to_string_lossy().into_owned();
        let battle = options.battle(file, &model);
        let outcome = fight(&battle, &Progress::Quiet, |_| Ok(()));
        let ride = Ride { model, outcome };
        watch(&ride, rides.len() + 1, files.len());
        rides.push(ride);
    }
    Ok(rides)
}

/// The rides as a Markdown table, followed by the first fault of every failed check.
pub fn table(rides: &[Ride]) -> String {
    let mut table = String::from(
        "| model | riding | standing | falls | drift, mm | pushed off, mm | stands off, mm | inside | rocks inside | rocks left | |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let mut causes = String::new();
    for Ride { model, outcome } in rides {
        // Writing to a string cannot fail.
        let _ = match outcome {
            Err(error) => writeln!(table, "| {model} | | | | | | | | | | refused: {error} |"),
            Ok(summary) => {
                for check in summary.checks.iter().filter(|check| !check.holds) {
                    let cause = check.cause.as_deref().unwrap_or("no cause recorded");
                    let _ = writeln!(causes, "{model}: {}: {cause}", check.name);
                }
                row(&mut table, model, summary)
            }
        };
    }
    let ridden = rides.iter().filter(|ride| ride.outcome.is_ok()).count();
    let held = rides.iter().filter(|ride| ride.holds()).count();
    format!("{table}\n{held} of {ridden} models pass all checks\n\n{causes}")
}

fn row(table: &mut String, model: &str, summary: &Summary) -> std::fmt::Result {
    let failed: Vec<&str> = summary
        .checks
        .iter()
        .filter(|check| !check.holds)
        .map(|check| check.name)
        .collect();
    let verdict = if failed.is_empty() {
        "ok".to_owned()
    } else {
        format!("fails: {}", failed.join("; "))
    };
    let stands = |mode: &&ModeTicks| mode.mode == "Standing";
    let standing = summary.modes.iter().find(stands);
    let standing = standing.map_or(0, |mode| mode.ticks);
    writeln!(
        table,
        "| {model} | {:.1} % | {:.1} % | {} | {:.4} | {:.1} | {:.1} | {} | {} | {} | {verdict} |",
        summary.riding_share * 100.0,
        standing as f64 / summary.ticks.max(1) as f64 * 100.0,
        summary.falls,
        summary.max_anchor_drift_m * 1e3,
        summary.max_pushed_off_m.unwrap_or(0.0) * 1e3,
        summary.max_stands_off_m.unwrap_or(0.0) * 1e3,
        summary.ticks_inside,
        summary.rocks_inside,
        summary.rocks_left,
    )
}
