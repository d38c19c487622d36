//! Recordings of one climber and its creature, in a scene that the game steps itself.

mod info;
mod recorder;
mod recording;
mod replay;
mod taken;
mod writing;

pub use info::RecordingInfo;
pub(crate) use info::{VERSION, common, hash, text, tick_seconds};
pub(crate) use recorder::ClimberMemory;
pub use recorder::{FigureView, Recorder, TickView};
pub use recording::{RecordedSnapshot, RecordedTick, Recording};
pub(crate) use replay::compare;
pub use replay::{Difference, ReplayError, Replayed, replay};
pub(crate) use taken::{ClimberTick, TakenSkin};
