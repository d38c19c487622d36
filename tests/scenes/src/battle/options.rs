use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::PathBuf;

use clamber_colossus::Brain;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use super::bot::Intent;
use super::{BattleError, Recording, Story, TICK};
use crate::{Creature, giant};

/// Height that a creature from a file is scaled to, metres.
const FILE_HEIGHT: f64 = 20.0;

/// Height that the giant is scaled to, metres: about its own.
const GIANT_HEIGHT: f64 = 40.0;

/// Length of a battle in each story, seconds.
const CLIMB_SECONDS: f64 = 200.0;
const RIDE_SECONDS: f64 = 60.0;

/// A climber fights a giant that hunts it, or rides a creature that walks and shakes, while rocks fall.
///
/// The climber comes over an outcrop, shoots two arrows, gets out of the way of the giant's blows or is knocked down by
/// them, grips a leg, climbs to the giant's weak points, breaks the plate over one of them, and stabs each until the
/// giant is dead. Or it is dropped on the creature's back, where it stands, walks and jumps, and holds on where the
/// skin is too steep to stand on. Checks in every tick that the climber is carried exactly and stays above the ground,
/// and several times a second that neither the climber nor a rock is inside the creature. Prints a table with the first
/// fault of each failed check, and exits with 1 if a check failed.
#[derive(Clone, Debug, Parser)]
#[command(name = "battle", version)]
pub struct BattleOptions {
    /// A skinned creature in a .glb or .gltf file [default: the giant, assets/colossus.glb].
    #[arg(long, value_name = "FILE")]
    pub creature: Option<PathBuf>,

    /// The brain that the creature lives by in a climb [default: the giant's, assets/colossus.brain.json; none for a
    /// creature from a file, which then walks and shakes by a timetable].
    #[arg(long, value_name = "FILE")]
    pub brain: Option<PathBuf>,

    /// Height of the creature [default: that of the file of --brain; without one 40 for the giant, and 20 for a creature
    /// from a file].
    #[arg(long, value_name = "METRES")]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub height: Option<f64>,

    /// What the climber does [default: climb for the giant and with a brain, else ride].
    #[arg(long, value_enum)]
    pub story: Option<Story>,

    /// Length of the battle [default: 200 for climb, 60 for ride].
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub seconds: Option<f64>,

    /// Number of rocks that fall on the creature; the climber does not collide with them.
    #[arg(long, value_name = "COUNT", default_value_t = 24)]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub rocks: u32,

    /// Seed for the climber's start and the rocks' places; the same number gives the same battle.
    #[arg(long, default_value_t = 21)]
    pub seed: u64,

    /// Who drives the climber in a climb.
    #[arg(long, value_enum, default_value = "bot")]
    pub pilot: PilotKind,

    /// Folder for summary.json and timeline.svg.
    #[arg(long, value_name = "DIR", default_value = "target/battle")]
    pub out: PathBuf,

    /// Record the battle to a file for Foxglove, Rerun and the replay example; needs --features record.
    #[arg(long, value_name = "FILE.mcap")]
    pub record: Option<PathBuf>,
}

/// Who drives the climber in a climb.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum PilotKind {
    /// A bot that plans its way on a graph of the creature's skin.
    #[default]
    Bot,
}

impl PilotKind {
    fn name(self) -> &'static str {
        match self {
            Self::Bot => "bot",
        }
    }
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number <= 1e6 => Ok(number),
        Ok(_) => Err("must be above 0 and at most 1000000".into()),
        Err(error) => Err(error.to_string()),
    }
}

impl Default for BattleOptions {
    fn default() -> Self {
        Self::parse_from(["battle"])
    }
}

impl BattleOptions {
    /// Parses the command line. For `--help` or a wrong argument it prints a message and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }

    /// A ride of 60 s on the giant. `seed` determines the climber's start and the rocks' places.
    pub fn ride(rocks: u32, seed: u64) -> Self {
        Self {
            story: Some(Story::Ride),
            rocks,
            seed,
            ..Self::default()
        }
    }

    /// The settings that make the same battle again, by the options' names: all but the paths of the results.
    ///
    /// # Errors
    /// [`BattleError::Settings`] if the path of the creature's file is not UTF-8.
    pub fn to_settings(&self) -> Result<BTreeMap<String, String>, BattleError> {
        let mut settings = BTreeMap::from([
            ("height".to_owned(), self.height().to_string()),
            ("story".to_owned(), self.story().name().to_owned()),
            ("seconds".to_owned(), self.seconds().to_string()),
            ("rocks".to_owned(), self.rocks.to_string()),
            ("seed".to_owned(), self.seed.to_string()),
            ("pilot".to_owned(), self.pilot.name().to_owned()),
        ]);
        for (name, path) in [("creature", &self.creature), ("brain", &self.brain)] {
            let Some(path) = path else {
                continue;
            };
            let unreadable =
                || BattleError::Settings(format!("the path {} is not UTF-8", path.display()));
            let path = path.to_str().ok_or_else(unreadable)?;
            settings.insert(name.to_owned(), path.to_owned());
        }
        Ok(settings)
    }

    /// Options from the settings that [`BattleOptions::to_settings`] gave.
    ///
    /// # Errors
    /// [`BattleError::Settings`] if the settings are not options of a battle.
    pub fn from_settings(settings: &BTreeMap<String, String>) -> Result<Self, BattleError> {
        let arguments = settings
            .iter()
            .map(|(name, value)| format!("--{name}={value}"));
        Self::try_parse_from(std::iter::once("battle".to_owned()).chain(arguments))
            .map_err(|error| BattleError::Settings(error.to_string()))
    }

    /// The brain's file: the option or its default; `None` for a creature that plays a timetable.
    pub fn brain_path(&self) -> Option<PathBuf> {
        if self.story() == Story::Ride {
            return None;
        }
        let default = || self.creature.is_none().then(giant::brain_path);
        self.brain.clone().or_else(default)
    }

    /// The creature's brain; `None` for a creature that plays a timetable.
    ///
    /// # Errors
    /// [`BattleError::ReadBrain`], [`BattleError::Brain`]; [`BattleError::Settings`] for a brain in a ride.
    pub(super) fn load_brain(&self) -> Result<Option<Brain>, BattleError> {
        if self.story() == Story::Ride && self.brain.is_some() {
            let reason = "a creature lives by its brain in a climb: add --story climb".to_owned();
            return Err(BattleError::Settings(reason));
        }
        let Some(path) = self.brain_path() else {
            return Ok(None);
        };
        let text = std::fs::read_to_string(&path).map_err(|error| BattleError::ReadBrain {
            path: path.clone(),
            reason: error.to_string(),
        })?;
        let brain = Brain::from_json(&text, TICK);
        brain
            .map(Some)
            .map_err(|error| BattleError::Brain { path, error })
    }

    pub(super) fn load_creature(&self) -> Result<Creature, BattleError> {
        Ok(match &self.creature {
            Some(path) => Creature::load(path)?,
            None => giant::giant()?,
        })
    }

    /// Height that the creature is scaled to, metres: the option, or that of the brain's file, or the default.
    pub fn height(&self) -> f64 {
        let default = match &self.creature {
            Some(_) => FILE_HEIGHT,
            None => GIANT_HEIGHT,
        };
        let height = self.height.or_else(|| self.height_of_brain());
        height.unwrap_or(default)
    }

    /// `None` without a brain, and with one that cannot be read, which [`Battle::new`](super::Battle::new) tells.
    fn height_of_brain(&self) -> Option<f64> {
        let text = std::fs::read_to_string(self.brain.as_ref()?).ok()?;
        let brain = Brain::from_json(&text, TICK).ok()?;
        brain.file().body.height
    }

    /// What the climber does: the option or its default.
    pub fn story(&self) -> Story {
        self.story.unwrap_or(match (&self.creature, &self.brain) {
            (Some(_), None) => Story::Ride,
            _ => Story::Climb,
        })
    }

    /// Length of the battle, seconds: the option or its default.
    pub fn seconds(&self) -> f64 {
        self.seconds.unwrap_or(match self.story() {
            Story::Climb => CLIMB_SECONDS,
            Story::Ride => RIDE_SECONDS,
        })
    }

    /// True for the climb of the default seed against the giant and its brain, at its size, to the end.
    pub(super) fn is_default_fight(&self) -> bool {
        let default = Self::default();
        self.story() == Story::Climb
            && self.creature.is_none()
            && self.brain.is_none()
            && self.seed == default.seed
            && self.height() == default.height()
            && self.seconds() >= default.seconds()
    }

    /// Length of the battle in ticks, at least 1.
    pub fn ticks(&self) -> u64 {
        ((self.seconds() / TICK).round() as u64).max(1)
    }

    /// The script: what the climber should do in a tick.
    ///
    /// [`Story::Climb`]: climb, in every tick. [`Story::Ride`]: stand for 40 % of the battle, walk to and fro on the
    /// back until 73 %, and stand again; at 57 % it means to jump, and does so once the skin is calm. Where the skin is
    /// too steep to stand on, the rider holds on and climbs up.
    pub fn input_at(&self, tick: u64) -> Intent {
        if self.story() == Story::Climb {
            return Intent::Climb;
        }
        let part = tick as f64 / self.ticks() as f64;
        let jump = self.ticks() * 57 / 100;
        if tick == jump {
            Intent::Jump
        } else if (0.4..0.73).contains(&part) {
            Intent::Patrol
        } else {
            Intent::Stand
        }
    }
}

/// Progress on standard error: a bar on a terminal, else a line for every ten seconds of the battle; nothing for many
/// battles in a row.
pub(super) enum Progress {
    Quiet,
    Bar(ProgressBar),
    Lines { ticks: u64 },
}

impl Progress {
    pub(super) fn new(ticks: u64) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self::Lines { ticks };
        }
        let bar = ProgressBar::new(ticks);
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  [{eta} left]");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self::Bar(bar)
    }

    pub(super) fn tick(&self, done: u64, recording: &Recording) {
        let Some(sample) = recording.samples().last() else {
            return;
        };
        let line = format!(
            "{:5.1} s  {}  {:5.1} m up",
            sample.seconds,
            sample.activity(),
            sample.height
        );
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                if done.is_multiple_of(16) {
                    bar.set_message(line);
                    bar.set_position(done);
                }
            }
            Self::Lines { ticks } => {
                let every = (10.0 / TICK).round() as u64;
                if done.is_multiple_of(every) || done == *ticks {
                    eprintln!("{line}");
                }
            }
        }
    }

    pub(super) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_height_is_the_options_or_the_brains_or_the_default() {
        let text = std::fs::read_to_string(giant::brain_path()).unwrap();
        let mut brain: serde_json::Value = serde_json::from_str(&text).unwrap();
        brain["body"]["height"] = 15.into();
        let name = format!("clamber-height-{}.json", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, brain.to_string()).unwrap();
        let options = |brain: Option<&PathBuf>, height| BattleOptions {
            creature: Some(giant::path()),
            brain: brain.cloned(),
            height,
            ..BattleOptions::default()
        };
        assert_eq!(options(Some(&path), None).height(), 15.0);
        assert_eq!(options(Some(&path), Some(9.0)).height(), 9.0);
        assert_eq!(options(None, None).height(), FILE_HEIGHT);
        let missing = PathBuf::from("no such file");
        assert_eq!(options(Some(&missing), None).height(), FILE_HEIGHT);
        std::fs::remove_file(&path).unwrap();
    }
}
