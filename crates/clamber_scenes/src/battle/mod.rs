//! The main scene: a valley, a creature that walks, stomps and shakes, a climber that comes over the ground, climbs to its
//! top and rides there, or is dropped on its back, and rocks that fall on it and roll off.
//!
//! One tick, in this order: the creature is posed, the climber steps, the physics steps with the rocks, the
//! scene checks what came of it.

pub mod bot;
mod checks;
mod choreography;
mod faults;
mod options;
mod outcrop;
mod pilot;
#[cfg(feature = "record")]
mod record;
mod recording;
mod repeat;
mod rides;
mod rockfall;
mod scene;
mod snapshot;
mod story;
mod summary;
mod timeline;

use std::path::PathBuf;

pub use choreography::Choreography;
pub use options::BattleOptions;
pub use outcrop::mesh as outcrop;
#[cfg(feature = "record")]
pub use record::{BattleRecorder, Replay, replay};
pub use recording::{Recording, Sample};
pub use rides::{Ride, RidesOptions, ride_all, table as rides_table};
pub use rockfall::{Rockfall, RockfallReport};
pub use scene::{Battle, CREATURE, TERRAIN, TICK};
pub use snapshot::BattleSnapshot;
pub use story::Story;
pub use summary::{Check, ModeTicks, Summary};

use options::Progress;

use crate::CreatureError;
use clamber_climber::ClimberError;
use clamber_surface::rig::RigError;
use clamber_surface::surface::SurfaceError;
use clamber_world::DebrisError;
use thiserror::Error;

/// Why a battle cannot be fought or written down.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BattleError {
    /// The creature cannot be loaded or posed.
    #[error("the creature cannot play: {0}")]
    Creature(#[from] CreatureError),
    /// The creature has no place where a climber could stand.
    #[error("found no place on {creature} to drop a climber on: no skin under the sky")]
    NoPerch {
        /// Its name.
        creature: String,
    },
    /// The creature has no way from the ground to its top.
    #[error(
        "found no way up {creature}: no skin near the ground from which a climber gets to the top; try --story ride"
    )]
    NoWay {
        /// Its name.
        creature: String,
    },
    /// The physics engine refuses the outcrop.
    #[error("the outcrop cannot stand in the valley: {0}")]
    Outcrop(String),
    /// The creature is flat.
    #[error("{creature} has no height in its first pose, so it cannot be scaled to {height} m")]
    NoHeight {
        /// Its name.
        creature: String,
        /// The height asked for.
        height: f64,
    },
    /// The climber refused.
    #[error(transparent)]
    Climber(#[from] ClimberError),
    /// A rock cannot be held against the creature.
    #[error(transparent)]
    Debris(#[from] DebrisError),
    /// `--record` in a build that cannot.
    #[error("this build cannot record: add --features record to cargo's arguments")]
    CannotRecord,
    /// A snapshot cannot be written or read.
    #[error("no snapshot of a battle: {0}")]
    Snapshot(String),
    /// Settings that no battle can be made from.
    #[error("no battle can be made from these settings: {0}")]
    Settings(String),
    /// There are no models to ride.
    #[error("no models to ride: {0}")]
    NoModels(String),
    /// Whoever watches the battle failed.
    #[error(transparent)]
    Watching(Box<dyn std::error::Error + Send + Sync>),
    /// The results cannot be written.
    #[error("cannot write {path}: {reason}")]
    Write {
        /// Which file or folder.
        path: PathBuf,
        /// Why.
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

/// Fights a battle from beginning to end, writes `summary.json` and `timeline.svg` into its folder,
/// which is made if need be, and gives the summary. Records it, if the options say so.
///
/// # Errors
/// [`BattleError`]. Failed checks are no error: they stand in the summary.
pub fn run(options: &BattleOptions) -> Result<Summary, BattleError> {
    run_watched(options, |_| Ok(()))
}

/// [`run`], and calls `watch` once before the first tick and after every tick: to draw it, say.
///
/// # Errors
/// As [`run`], and those of `watch`, which end the battle.
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
    // First, so that a folder that cannot be is not found out about at the end.
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
    timeline::draw(battle.recording(), &summary, &options.out)?;
    Ok(summary)
}
