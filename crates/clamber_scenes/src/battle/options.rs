use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::PathBuf;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use super::bot::Intent;
use super::{BattleError, Recording, Story, TICK};
use crate::{Creature, giant::giant};

/// Metres; what a creature from a file is scaled to.
const FILE_HEIGHT: f64 = 20.0;

/// Metres; what the giant is scaled to, and about what it has.
const GIANT_HEIGHT: f64 = 40.0;

/// How long battles take.
const CLIMB_SECONDS: f64 = 78.0;
const RIDE_SECONDS: f64 = 60.0;

/// A climber climbs and rides a walking, stomping, shaking creature on which rocks fall.
///
/// The climber comes over an outcrop, is knocked down by a stomp, grips a leg and climbs to the creature's top, where it
/// stays; or it is dropped on the back, where it stands, walks and jumps, and holds on where it is too steep to stand. Checks at every tick that it is carried exactly
/// and stays above the ground, and several times a second that neither it nor a rock is inside the creature. Ends with
/// a table, with the first fault of each check that failed, and exits with 1 if one did.
#[derive(Clone, Debug, Parser)]
#[command(name = "battle", version)]
pub struct BattleOptions {
    /// A skinned creature in a .glb or .gltf file [default: the giant, assets/colossus.glb].
    #[arg(long, value_name = "FILE")]
    pub creature: Option<PathBuf>,

    /// Height of the creature [default: 40 for the giant, 20 for one from a file].
    #[arg(long, value_name = "METRES")]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub height: Option<f64>,

    /// What the climber does [default: climb the giant, ride a creature from a file].
    #[arg(long, value_enum)]
    pub story: Option<Story>,

    /// Length of the battle [default: 78 to climb, 60 to ride].
    #[arg(long, value_name = "SECONDS")]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    pub seconds: Option<f64>,

    /// Rocks that fall on the creature; the climber does not feel them.
    #[arg(long, value_name = "COUNT", default_value_t = 24)]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub rocks: u32,

    /// Where exactly the climber begins and the rocks come down: any number; the same one gives the same battle.
    #[arg(long, default_value_t = 2)]
    pub seed: u64,

    /// Folder for summary.json and timeline.svg.
    #[arg(long, value_name = "DIR", default_value = "target/battle")]
    pub out: PathBuf,

    /// Records the battle to a file for Foxglove, Rerun and the replay example; needs --features record.
    #[arg(long, value_name = "FILE.mcap")]
    pub record: Option<PathBuf>,
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
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
    /// From the command line; prints help or what is wrong with it, and exits.
    pub fn from_command_line() -> Self {
        Self::parse()
    }

    /// A minute's ride on the giant, the climber's and the rocks' places by a seed.
    pub fn ride(rocks: u32, seed: u64) -> Self {
        Self {
            story: Some(Story::Ride),
            rocks,
            seed,
            ..Self::default()
        }
    }

    /// What makes the same battle again, by the names of the options: all but where results go.
    ///
    /// # Errors
    /// [`BattleError::Settings`] if the creature's file has a name that is no text.
    pub fn to_settings(&self) -> Result<BTreeMap<String, String>, BattleError> {
        let mut settings = BTreeMap::from([
            ("height".to_owned(), self.height().to_string()),
            ("story".to_owned(), self.story().name().to_owned()),
            ("seconds".to_owned(), self.seconds().to_string()),
            ("rocks".to_owned(), self.rocks.to_string()),
            ("seed".to_owned(), self.seed.to_string()),
        ]);
        if let Some(path) = &self.creature {
            let unreadable = || BattleError::Settings(format!("{} is no text", path.display()));
            let path = path.to_str().ok_or_else(unreadable)?;
            settings.insert("creature".to_owned(), path.to_owned());
        }
        Ok(settings)
    }

    /// From [`BattleOptions::to_settings`].
    ///
    /// # Errors
    /// [`BattleError::Settings`] if they are not options of a battle.
    pub fn from_settings(settings: &BTreeMap<String, String>) -> Result<Self, BattleError> {
        let arguments = settings
            .iter()
            .map(|(name, value)| format!("--{name}={value}"));
        Self::try_parse_from(std::iter::once("battle".to_owned()).chain(arguments))
            .map_err(|error| BattleError::Settings(error.to_string()))
    }

    pub(super) fn load_creature(&self) -> Result<Creature, BattleError> {
        Ok(match &self.creature {
            Some(path) => Creature::load(path)?,
            None => giant()?,
        })
    }

    /// How tall the creature is to be, metres.
    pub fn height(&self) -> f64 {
        let default = match &self.creature {
            Some(_) => FILE_HEIGHT,
            None => GIANT_HEIGHT,
        };
        self.height.unwrap_or(default)
    }

    /// What the climber does.
    pub fn story(&self) -> Story {
        self.story.unwrap_or(match &self.creature {
            Some(_) => Story::Ride,
            None => Story::Climb,
        })
    }

    /// How long it lasts.
    pub fn seconds(&self) -> f64 {
        self.seconds.unwrap_or(match self.story() {
            Story::Climb => CLIMB_SECONDS,
            Story::Ride => RIDE_SECONDS,
        })
    }

    /// It lasts as long as its story takes, or longer.
    pub(super) fn is_whole(&self) -> bool {
        let whole = Self {
            seconds: None,
            ..self.clone()
        };
        self.seconds() >= whole.seconds()
    }

    /// How many ticks it lasts.
    pub fn ticks(&self) -> u64 {
        ((self.seconds() / TICK).round() as u64).max(1)
    }

    /// The script. To climb: all the way. To ride: stands for four tenths of the battle, walks up and down the back for the
    /// next third, jumps once as soon as the skin is calm after the middle of that, and stands again; where it is too steep to
    /// stand it holds on and climbs up.
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

/// A bar on a terminal, a line every ten seconds of the battle elsewhere; nothing where many battles are fought.
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
