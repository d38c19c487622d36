//! Recordings of one climber and its creature, in a scene that the game steps itself.

mod info;
mod recorder;
mod recording;
mod tick;

pub use info::RecordingInfo;
pub(crate) use info::{VERSION, common, hash, text, tick_seconds};
pub(crate) use recorder::ClimberMemory;
pub use recorder::{FigureView, Recorder, TickView};
pub use recording::{
    Difference, RecordedSnapshot, RecordedTick, Recording, ReplayError, Replayed, replay,
};
pub(crate) use tick::{ClimberTick, TakenSkin};
