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
mod rockfall;
mod scene;

use clamber_climber::ClimberInput;

pub use checks::{
    Check, DRIFT, FALLS, INSIDE, MAX_DRIFT, MAX_STANDS_OFF, PUSH_OUT, PUSHED_OFF, ROCKS_INSIDE,
    STANDS_OFF, Watch,
};
pub use counts::Counts;
pub use options::{BattleOptions, Story, positive, within};
pub use outcrop::mesh as outcrop;
#[cfg(feature = "record")]
pub use record::{BattleRecorder, Replay, replay};
pub use repeat::Repeat;
pub use ride::Intent;
pub use rockfall::{Rockfall, Triangles};
pub use scene::{Battle, BattleSnapshot, CREATURE, TERRAIN, TICK};

pub use crate::SceneError;

/// The input of a climber that holds on where it is.
const GRIP: ClimberInput = ClimberInput {
    grip: true,
    ..ClimberInput::IDLE
};
