//! Recordings of an arena, in which several creatures and climbers fight.

mod info;
mod lines;
mod recorder;
mod recording;
mod tick;

pub use info::ArenaInfo;
pub(crate) use recorder::ArenaMemory;
pub use recorder::ArenaRecorder;
pub use recording::{ArenaDifference, ArenaRecording, ArenaReplay, RecordedArenaTick};
pub(crate) use tick::TakenArena;
