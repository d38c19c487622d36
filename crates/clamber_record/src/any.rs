use std::path::Path;

use crate::{ArenaInfo, ArenaRecording, Ending, RecordError, Recording, file};

/// A recording of either kind, for programs that open a file without knowing its kind.
#[derive(Clone, Debug)]
pub enum AnyRecording {
    /// A recording of one climber and its creature, written by a [`Recorder`](crate::Recorder).
    Climber(Box<Recording>),
    /// A recording of an arena, written by an [`ArenaRecorder`](crate::ArenaRecorder).
    Arena(Box<ArenaRecording>),
}

impl AnyRecording {
    /// Reads a recording from a file of any length.
    ///
    /// # Errors
    /// As [`Recording::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordError> {
        let contents = file::open(path.as_ref())?;
        Ok(if contents.metadata.contains_key(ArenaInfo::METADATA) {
            Self::Arena(Box::new(ArenaRecording::from_contents(contents)?))
        } else {
            Self::Climber(Box::new(Recording::from_contents(contents)?))
        })
    }

    /// True if the recording has no ticks.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Climber(recording) => recording.is_empty(),
            Self::Arena(recording) => recording.is_empty(),
        }
    }

    /// Number of ticks that the recorder left out after the last recorded tick.
    pub fn lost_at_end(&self) -> u64 {
        match self {
            Self::Climber(recording) => recording.lost_at_end(),
            Self::Arena(recording) => recording.lost_at_end(),
        }
    }

    /// How the file ends.
    pub fn ending(&self) -> &Ending {
        match self {
            Self::Climber(recording) => recording.ending(),
            Self::Arena(recording) => recording.ending(),
        }
    }
}
