//! The main scene: a climber against a giant creature in a valley, while rocks fall.
//!
//! In a climb the creature lives by its brain: it notices the climber, hunts and attacks it, and shakes itself once it
//! is ridden. A bot plays the climber in a [`clamber_fight::Arena`]: it comes over the ground, gets out of the way of
//! blows, climbs to the weak points and stabs them. In a ride the creature plays its clips by a timetable, and the
//! climber is dropped on its back. The rocks fall on the creature and roll off.
//!
//! Order of a tick: the creature and the climber step, then the physics with the rocks. [`Watch`] checks the result.

mod bot;
mod checks;
mod choreography;
mod counts;
mod eyes;
mod fencer;
mod footing;
mod options;
mod outcrop;
#[cfg(feature = "record")]
mod record;
mod repeat;
mod ride;
mod rider;
mod rockfall;
mod scene;

pub use checks::{
    Check, DRIFT, FALLS, INSIDE, MAX_DRIFT, MAX_STANDS_OFF, ROCKS_INSIDE, STANDS_OFF, Watch,
};
pub use counts::Counts;
pub use options::{BattleOptions, Story, positive};
pub use outcrop::mesh as outcrop;
#[cfg(feature = "record")]
pub use record::{BattleRecorder, Replay, replay};
pub use repeat::Repeat;
pub use rider::Intent;
pub use rockfall::{Rockfall, Triangles};
pub use scene::{Battle, BattleSnapshot, CREATURE, CreatureState, TERRAIN, TICK};

use std::error::Error;

use crate::CreatureError;
use clamber_climber::ClimberError;
use clamber_colossus::ColossusError;
use clamber_fight::ArenaError;
use clamber_navigation::NavigationError;
use clamber_surface::rig::RigError;
use clamber_surface::surface::SurfaceError;
use clamber_world::DebrisError;

/// Why a battle cannot be made, stepped, recorded or drawn.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct BattleError(Box<dyn Error + Send + Sync>);

impl BattleError {
    /// An error of another library, or a sentence.
    pub fn new(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(error.into())
    }
}

macro_rules! from {
    ($($error:ty),+) => {$(
        impl From<$error> for BattleError {
            fn from(error: $error) -> Self {
                Self(error.into())
            }
        }
    )+};
}

from!(
    ArenaError,
    ClimberError,
    ColossusError,
    CreatureError,
    DebrisError,
    NavigationError,
    RigError,
    SurfaceError
);
from!(String, serde_json::Error);
