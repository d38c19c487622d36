//! The main scene: a climber against a giant creature in a valley, while rocks fall.
//!
//! In a climb the creature lives by its brain: it notices the climber, hunts and attacks it, and shakes itself once it
//! is ridden. The climber comes over the ground, gets out of the way of blows, climbs to the creature's top and stays
//! there. In a ride the creature plays its clips by a timetable, and the climber is dropped on its back. The rocks fall
//! on the creature and roll off.
//!
//! A fight is a thin program over [`clamber_fight::Arena`]: a bot gives the inputs. Order of a tick: the creature and
//! the climber step, then the physics with the rocks, and the scene checks the result.

pub mod bot;
mod checks;
mod choreography;
mod crossing;
mod eyes;
mod faults;
mod fencer;
mod grips;
mod options;
mod outcrop;
mod performer;
mod planner;
#[cfg(feature = "record")]
mod record;
mod recording;
mod repeat;
mod rides;
mod rockfall;
mod scene;
mod siege;
mod snapshot;
mod story;
mod summary;
mod tally;
mod timeline;

use std::path::PathBuf;

pub use choreography::Choreography;
pub use options::{BattleOptions, PilotKind};
pub use outcrop::mesh as outcrop;
pub use performer::{Performer, PerformerState};
#[cfg(feature = "record")]
pub use record::{BattleRecorder, Replay, replay};
pub use recording::{Recording, Sample};
pub(crate) use repeat::Repeat;
pub use rides::{Ride, RidesOptions, ride_all, table as rides_table};
pub use rockfall::{Rockfall, RockfallReport};
pub use scene::{Battle, CREATURE, TERRAIN, TICK};
pub use siege::{Fight, HEADING, fight_all};
pub use snapshot::BattleSnapshot;
pub use story::Story;
pub use summary::{Check, ModeTicks, StateTicks, Summary};
pub use tally::Tally;

use options::Progress;
pub(crate) use options::positive;

use crate::CreatureError;
use clamber_climber::ClimberError;
use clamber_colossus::{BrainError, ColossusError};
use clamber_fight::ArenaError;
use clamber_navigation::NavigationError;
use clamber_surface::rig::RigError;
use clamber_surface::surface::SurfaceError;
use clamber_world::DebrisError;
use thiserror::Error;

/// Why a battle cannot be run, recorded or written to files.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BattleError {
    /// The creature cannot be loaded or posed.
    #[error("the creature cannot be loaded or posed: {0}")]
    Creature(#[from] CreatureError),
    /// The creature has no skin that a climber could be dropped on.
    #[error("found no place to drop a climber on {creature}: no ray from above meets its skin")]
    NoPerch {
        /// The creature's name.
        creature: String,
    },
    /// The brain's file cannot be read.
    #[error("cannot read the brain {path}: {reason}")]
    ReadBrain {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The brain is not valid.
    #[error("{path}: {error}")]
    Brain {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: BrainError,
    },
    /// The creature cannot live by its brain.
    #[error("the creature cannot live by its brain: {0}")]
    Colossus(#[from] ColossusError),
    /// The arena refuses something.
    #[error(transparent)]
    Arena(#[from] ArenaError),
    /// The creature has no way from the ground to its top.
    #[error(
        "found no way up {creature}: no grippable skin leads from near the ground to the top; try --story ride"
    )]
    NoWay {
        /// The creature's name.
        creature: String,
    },
    /// The creature's skin cannot be divided into a graph.
    #[error(transparent)]
    Navigation(#[from] NavigationError),
    /// The physics engine rejects the outcrop's mesh.
    #[error("the outcrop cannot be added to the valley: {0}")]
    Outcrop(String),
    /// The creature is flat in its first pose.
    #[error("{creature} has no height in its first pose, so it cannot be scaled to {height} m")]
    NoHeight {
        /// The creature's name.
        creature: String,
        /// The height asked for, metres.
        height: f64,
    },
    /// The climber rejected its settings, its state or its input.
    #[error(transparent)]
    Climber(#[from] ClimberError),
    /// A rock cannot collide with the creature.
    #[error(transparent)]
    Debris(#[from] DebrisError),
    /// `--record` was given to a build without the feature `record`.
    #[error("this build cannot record: add --features record to cargo's arguments")]
    CannotRecord,
    /// A snapshot cannot be written or read.
    #[error("the snapshot of a battle cannot be written or read: {0}")]
    Snapshot(String),
    /// The settings are not options of a battle.
    #[error("no battle can be made from these settings: {0}")]
    Settings(String),
    /// No models to ride were found.
    #[error("no models to ride: {0}")]
    NoModels(String),
    /// The caller's `watch` function or the recording failed.
    #[error(transparent)]
    Watching(Box<dyn std::error::Error + Send + Sync>),
    /// The results cannot be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
}

impl From<RigError> for BattleError {
    fn from(error: RigError) -> Self {
        Self::Creature(error.into())
    }
}

impl From<SurfaceError> for BattleError {
    fn from(error: SurfaceError) -> Self {
        Self::Creature(error.into())
    }
}

/// Runs a battle from beginning to end, and returns its summary.
///
/// Writes `summary.json` and `timeline.svg` into the folder [`BattleOptions::out`], which is created if needed. Records
/// the battle if [`BattleOptions::record`] is set. Shows its progress on standard error.
///
/// # Errors
/// [`BattleError`]. Failed checks are not errors: the summary lists them.
pub fn run(options: &BattleOptions) -> Result<Summary, BattleError> {
    run_watched(options, |_| Ok(()))
}

/// As [`run`], and calls `watch` once before the first tick and after every tick, for example to draw the battle.
///
/// # Errors
/// As [`run`]. An error of `watch` ends the battle and is returned.
pub fn run_watched(
    options: &BattleOptions,
    watch: impl FnMut(&Battle<'_>) -> Result<(), BattleError>,
) -> Result<Summary, BattleError> {
    let Some(path) = &options.record else {
        return fight(options, &Progress::new(options.ticks()), watch);
    };
    #[cfg(feature = "record")]
    {
        record::run(options, path, watch)
    }
    #[cfg(not(feature = "record"))]
    {
        let _ = path;
        Err(BattleError::CannotRecord)
    }
}

fn fight(
    options: &BattleOptions,
    progress: &Progress,
    mut watch: impl FnMut(&Battle<'_>) -> Result<(), BattleError>,
) -> Result<Summary, BattleError> {
    // First, so that a folder that cannot be created ends the run at once.
    std::fs::create_dir_all(&options.out).map_err(|error| BattleError::Write {
        path: options.out.clone(),
        reason: error.to_string(),
    })?;
    let creature = options.load_creature()?;
    let mut battle = Battle::new(&creature, options)?;
    let ticks = options.ticks();
    watch(&battle)?;
    for tick in 0..ticks {
        battle.step(options.input_at(tick))?;
        watch(&battle)?;
        progress.tick(tick + 1, battle.recording());
    }
    progress.finish();
    let summary = Summary::new(&battle, options);
    summary.write(&options.out)?;
    timeline::draw(&battle, &summary, &options.out)?;
    Ok(summary)
}
