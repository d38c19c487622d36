use std::path::PathBuf;

use clamber_scenes::battle::{BattleOptions, within};
use clap::{ArgGroup, CommandFactory, Parser, error::ErrorKind};

/// A climber fights a giant that hunts it, or rides a creature that walks and shakes, while rocks fall.
///
/// Checks in every tick that the climber is carried exactly and stays above the ground, and several times a second that
/// neither the climber nor a rock is inside the creature. Prints a table with the first fault of each failed check, and
/// exits with 1 if a check failed, and with 2 after an error.
#[derive(Debug, Parser)]
#[command(name = "battle", version)]
pub(crate) struct Options {
    #[command(flatten)]
    pub(crate) battle: BattleOptions,

    /// Folder for summary.json.
    #[arg(long, value_name = "DIR", default_value = "target/battle")]
    pub(crate) out: PathBuf,

    /// Record the battle to a file for Foxglove, Rerun and the replay example; needs --features record.
    #[arg(long, value_name = "FILE.mcap")]
    pub(crate) record: Option<PathBuf>,

    /// Fights this number of battles, with this seed and the next ones, each until the creature is dead. Prints a line
    /// for each, and writes no files.
    #[arg(long, value_name = "COUNT", conflicts_with_all = ["pictures", "record", "out"])]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(crate) fights: Option<u64>,

    #[command(flatten)]
    pub(crate) film: FilmOptions,
}

/// Options for filming the battle.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Filming, with --features render")]
#[command(group = ArgGroup::new("pictures").args(["frames", "gif"]).multiple(true))]
#[command(group = ArgGroup::new("film").multiple(true).requires("pictures"))]
pub(crate) struct FilmOptions {
    /// Folder for pictures: 00000.png, 00001.png and so on.
    #[arg(long, value_name = "DIR")]
    pub(crate) frames: Option<PathBuf>,

    /// File for an animated GIF of half the size.
    #[arg(long, value_name = "FILE")]
    pub(crate) gif: Option<PathBuf>,

    /// How the camera moves.
    #[arg(long, group = "film", value_enum, default_value = "orbit")]
    pub(crate) camera: CameraKind,

    /// Overlays that are drawn over the pictures, separated by commas.
    #[arg(long, group = "film", value_enum, value_delimiter = ',')]
    pub(crate) overlay: Vec<OverlayKind>,

    /// Pictures per second of the battle, from 0.01 to 60: 0.25 is one in four seconds.
    #[arg(long, group = "film", value_name = "COUNT", default_value_t = 15.0)]
    #[arg(value_parser = |text: &str| within(text, 0.01, 60.0), allow_negative_numbers = true)]
    pub(crate) rate: f64,

    /// Seconds of the battle before filming begins.
    #[arg(long, group = "film", value_name = "SECONDS", default_value_t = 0.0)]
    #[arg(value_parser = |text: &str| within(text, 0.0, 1e6), allow_negative_numbers = true)]
    pub(crate) from: f64,

    /// Width of a picture, pixels.
    #[arg(long, group = "film", value_name = "PIXELS", default_value_t = 1280)]
    pub(crate) width: u32,

    /// Height of a picture, rows of pixels.
    #[arg(long, group = "film", value_name = "PIXELS", default_value_t = 720)]
    pub(crate) rows: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum CameraKind {
    /// Circles around the creature.
    Orbit,
    /// Follows the climber, outside of fur.
    Chase,
    /// Beside the climber, near enough to see its hands.
    Close,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum OverlayKind {
    /// The skeleton.
    Joints,
    /// The triangle under the climber, and the climber's path.
    Contact,
    /// A material point on each part, and the climber's own point, with their velocities.
    Anchors,
    /// The way that the bot follows, with yellow dots where it rests and magenta ones for its goal.
    Plan,
    /// The skin, coloured by the time from there to the bot's goal: from red to blue, which is half a minute or more.
    Ways,
    /// Text: time, the climber's mode, stamina and health, shake, speed over the skin, share of vertices skinned.
    State,
}

impl Options {
    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub(crate) fn from_command_line() -> Self {
        let options = Self::parse();
        let (from, seconds) = (options.film.from, options.battle.seconds());
        if options.film.is_wanted() && from > seconds {
            let reason =
                format!("nothing to film: the battle ends after {seconds} s, and --from is {from}");
            Self::command()
                .error(ErrorKind::ValueValidation, reason)
                .exit();
        }
        options
    }
}

impl FilmOptions {
    pub(crate) fn is_wanted(&self) -> bool {
        self.frames.is_some() || self.gif.is_some()
    }
}
