#![doc = include_str!("../README.md")]

mod any;
mod arena;
mod chunks;
mod config;
mod error;
mod file;
mod info;
mod kind;
mod messages;
mod names;
mod output;
mod places;
mod recorder;
mod recording;
mod replay;
mod source;
mod taken;
pub mod topics;
mod views;
mod writing;

pub use any::AnyRecording;
pub use arena::{
    ArenaDifference, ArenaInfo, ArenaRecorder, ArenaRecording, ArenaReplay, RecordedArenaTick,
};
pub use clamber_surface::surface::{creature_fingerprint, palette_fingerprint};
pub use error::RecordError;
pub use info::RecordingInfo;
pub use kind::{OfArena, OfClimber, RecordingKind};
pub use recorder::{FigureView, RecordOptions, Recorder, RecorderOf, TickView};
pub use recording::{Ending, RecordedSnapshot, RecordedTick, Recording, RecordingOf};
pub use replay::{Difference, ReplayError, Replayed, replay};
pub use views::SceneryView;
