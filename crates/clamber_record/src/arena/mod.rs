//! Recordings of an arena, in which several creatures and climbers fight.

mod info;
mod lines;
mod recorder;
mod recording;
mod replay;
mod taken;
mod writing;

pub use info::ArenaInfo;
pub(crate) use recorder::ArenaMemory;
pub use recorder::ArenaRecorder;
pub use recording::{ArenaRecording, RecordedArenaTick};
pub use replay::{ArenaDifference, ArenaReplay};
pub(crate) use taken::TakenArena;
