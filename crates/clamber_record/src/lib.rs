#![doc = include_str!("../README.md")]

mod any;
mod arena;
mod chunks;
mod climber;
mod error;
mod file;
mod kind;
mod messages;
mod names;
mod output;
mod places;
mod recorder;
mod recording;
mod source;
pub mod topics;
mod views;

pub use any::AnyRecording;
pub use arena::{
    ArenaDifference, ArenaInfo, ArenaRecorder, ArenaRecording, ArenaReplay, RecordedArenaTick,
};
pub use clamber_surface::surface::{creature_fingerprint, palette_fingerprint};
pub use climber::{
    Difference, FigureView, RecordedSnapshot, RecordedTick, Recorder, Recording, RecordingInfo,
    ReplayError, Replayed, TickView, replay,
};
pub use error::RecordError;
pub use kind::{OfArena, OfClimber, RecordingKind};
pub use recorder::{RecordOptions, RecorderOf};
pub use recording::{Ending, RecordingOf};
pub use views::SceneryView;
