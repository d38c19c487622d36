use std::path::PathBuf;

use clap::Parser;

use crate::battle::BattleError;
use crate::test_data;

/// A bot climbs every model of a folder, from the ground to the highest place that the model's graph calls reachable
/// with the strength that the bot counts on, and a table shows how long it takes.
///
/// All skin can be gripped, as if it were fur. Exits with 1 if the bot does not come there on 20 of 27 models.
#[derive(Clone, Debug, Parser)]
#[command(name = "climbs", version)]
pub struct ClimbsOptions {
    /// Models in .glb or .gltf files [default: all files of models/ in the folder that CLAMBER_TEST_DATA names].
    #[arg(value_name = "FILE")]
    pub models: Vec<PathBuf>,

    /// Height of every creature.
    #[arg(long, value_name = "METRES", default_value_t = 20.0)]
    #[arg(value_parser = crate::battle::positive, allow_negative_numbers = true)]
    pub height: f64,

    /// Time that the bot has.
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0)]
    #[arg(value_parser = crate::battle::positive, allow_negative_numbers = true)]
    pub seconds: f64,

    /// Ticks a second.
    #[arg(long, value_name = "HERTZ", default_value_t = 60.0)]
    #[arg(value_parser = crate::battle::positive, allow_negative_numbers = true)]
    pub rate: f64,

    /// Each model idles and walks by turns, 30 s each, slowed by Froude's law to its height; with neither it plays what
    /// else it has [default: it stands at rest].
    #[arg(long)]
    pub moving: bool,

    /// The bot is told what the model is about to do.
    #[arg(long, requires = "moving")]
    pub forecast: bool,
}

impl Default for ClimbsOptions {
    fn default() -> Self {
        Self::parse_from(["climbs"])
    }
}

impl ClimbsOptions {
    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }

    /// The models' files: those of the options, in their order, or all of the default folder, sorted.
    ///
    /// # Errors
    /// As [`test_data::models_or`].
    pub fn files(&self) -> Result<Vec<PathBuf>, BattleError> {
        Ok(test_data::models_or(&self.models)?)
    }
}
