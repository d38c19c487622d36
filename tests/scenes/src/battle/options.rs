use std::collections::BTreeMap;
use std::path::PathBuf;

use clamber_colossus::Brain;
use clap::Parser;

use super::{Intent, SceneError, TICK};
use crate::{Creature, giant};

/// Height that a creature from a file is scaled to, metres.
const FILE_HEIGHT: f64 = 20.0;

/// Height that the giant is scaled to, metres: about its own.
const GIANT_HEIGHT: f64 = 40.0;

/// Length of a climb, seconds: enough for the default seed to kill the giant.
const CLIMB_SECONDS: f64 = 200.0;

/// Length of a ride, seconds.
const RIDE_SECONDS: f64 = 60.0;

/// The climber's task in a battle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Story {
    /// The climber comes over an outcrop, shoots, runs from blows, climbs to the weak points and stabs them.
    Climb,
    /// The climber is dropped on the back, and stands, walks and jumps there.
    Ride,
}

/// The settings of a battle.
#[derive(Clone, Debug, Parser)]
#[command(name = "battle")]
pub struct BattleOptions {
    /// A skinned creature in a .glb or .gltf file [default: the giant, assets/colossus.glb].
    #[arg(long, value_name = "FILE")]
    pub creature: Option<PathBuf>,

    /// The brain that the creature lives by in a climb [default: the giant's, assets/colossus.brain.json; none for a
    /// creature from a file, which then walks and shakes by a timetable].
    #[arg(long, value_name = "FILE")]
    pub brain: Option<PathBuf>,

    /// Height of the creature [default: the height in the file of --brain; if there is none, 40 for the giant, and 20
    /// for a creature from a file].
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
}

/// The number of an option, above 0 and at most 1,000,000.
///
/// # Errors
/// A sentence for the user.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number <= 1e6 => Ok(number),
        Ok(_) => Err("must be above 0 and at most 1000000".into()),
        Err(error) => Err(error.to_string()),
    }
}

/// The number of an option, from `least` to `most`.
///
/// # Errors
/// A sentence for the user.
pub fn within(text: &str, least: f64, most: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        Ok(_) => Err(format!("must be from {least} to {most}")),
        Err(error) => Err(error.to_string()),
    }
}

impl Default for BattleOptions {
    fn default() -> Self {
        Self::parse_from(["battle"])
    }
}

impl BattleOptions {
    /// A ride of 60 s on the giant. `seed` determines the climber's start and the rocks' places.
    pub fn ride(rocks: u32, seed: u64) -> Self {
        Self {
            story: Some(Story::Ride),
            rocks,
            seed,
            ..Self::default()
        }
    }

    /// The settings that make the same battle again, by the options' names.
    pub fn to_settings(&self) -> BTreeMap<String, String> {
        let story = match self.story() {
            Story::Climb => "climb",
            Story::Ride => "ride",
        };
        let text = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
        let settings = [
            ("height", Some(self.height().to_string())),
            ("story", Some(story.to_owned())),
            ("seconds", Some(self.seconds().to_string())),
            ("rocks", Some(self.rocks.to_string())),
            ("seed", Some(self.seed.to_string())),
            ("creature", text(&self.creature)),
            ("brain", text(&self.brain)),
        ];
        let given = settings.map(|(name, value)| Some((name.to_owned(), value?)));
        given.into_iter().flatten().collect()
    }

    /// Options from the settings that [`BattleOptions::to_settings`] gave.
    pub fn from_settings(settings: &BTreeMap<String, String>) -> Result<Self, SceneError> {
        let argument = |(name, value): (&String, &String)| format!("--{name}={value}");
        let program = std::iter::once("battle".to_owned());
        let words = program.chain(settings.iter().map(argument));
        Ok(Self::try_parse_from(words)?)
    }

    /// The creature's brain; `None` in a ride.
    ///
    /// # Errors
    /// [`SceneError`] if the file is no brain, for a climb without a brain, and for a ride with one.
    pub(super) fn load_brain(&self) -> Result<Option<Brain>, SceneError> {
        let path = match (self.story(), &self.brain) {
            (Story::Ride, None) => return Ok(None),
            (Story::Ride, Some(_)) => {
                return Err("a creature lives by its brain in a climb: add --story climb".into());
            }
            (Story::Climb, Some(path)) => path.clone(),
            (Story::Climb, None) if self.creature.is_none() => giant::brain_path(),
            (Story::Climb, None) => {
                let reason = "a creature of a file needs a brain to be fought: add --brain FILE, or --story ride";
                return Err(reason.into());
            }
        };
        let name = path.display();
        let text = std::fs::read_to_string(&path)
            .map_err(|error| format!("cannot read the brain {name}: {error}"))?;
        let brain = Brain::from_json(&text, TICK).map_err(|error| format!("{name}: {error}"))?;
        Ok(Some(brain))
    }

    /// Loads the creature.
    pub fn load_creature(&self) -> Result<Creature, SceneError> {
        match &self.creature {
            Some(path) => Creature::load(path),
            None => giant::giant(),
        }
    }

    /// Height that the creature is scaled to, metres: the option, or the height in the brain's file, or the default.
    pub fn height(&self) -> f64 {
        let height = self.height.or_else(|| self.height_of_brain());
        height.unwrap_or(match &self.creature {
            Some(_) => FILE_HEIGHT,
            None => GIANT_HEIGHT,
        })
    }

    /// `None` without a brain, and with one that cannot be read, which [`Battle::new`](super::Battle::new) reports.
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

    /// The script of a ride: stand for 40 % of the battle, walk to and fro on the back until 73 %, and stand again; at
    /// 57 % the rider means to jump, and does so once the skin is calm. A climb has no script: the bot plays it.
    pub fn input_at(&self, tick: u64) -> Intent {
        let part = tick as f64 / self.ticks() as f64;
        if tick == self.ticks() * 57 / 100 {
            Intent::Jump
        } else if (0.4..0.73).contains(&part) {
            Intent::Patrol
        } else {
            Intent::Stand
        }
    }
}
