#![doc = include_str!("../README.md")]

mod config;
mod error;
mod file;
mod info;
mod messages;
mod recorder;
mod recording;
mod replay;
mod taken;
pub mod topics;
mod views;
mod writing;

pub use clamber_surface::surface::{creature_fingerprint, palette_fingerprint};
pub use error::RecordError;
pub use info::RecordingInfo;
pub use recorder::{FigureView, RecordOptions, Recorder, TickView};
pub use recording::{Ending, RecordedSnapshot, RecordedTick, Recording};
pub use replay::{Difference, ReplayError, Replayed, replay};
