use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::file::{self, Contents};
use crate::messages::{Snapshot, Tick};
use crate::output::{GAP, GAP_TICKS};
use crate::places::Places;
use crate::source::{Bytes, Place, Source};
use crate::{OfArena, OfClimber, RecordError, RecordingInfo, RecordingKind, topics};
use clamber_climber::{ClimberInput, ClimberState};

/// How the file of a recording ends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ending {
    /// The file is whole: its recorder finished it.
    Whole,
    /// The file ends early: its recorder was stopped, or the file was cut.
    #[default]
    Early,
    /// The file is damaged from a byte on; everything before it is whole.
    Damaged {
        /// Offset of that byte in the file.
        at: u64,
        /// Description of the damage.
        reason: String,
    },
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => f.write_str("file is whole"),
            Self::Early => f.write_str("file ends early"),
            Self::Damaged { at, reason } => write!(f, "file is damaged at byte {at} ({reason})"),
        }
    }
}

/// One tick as it was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedTick {
    /// Number of the tick.
    pub tick: u64,
    /// The climber's input in this tick.
    pub input: ClimberInput,
    /// The climber's state at the end of the tick, bit for bit.
    pub state: ClimberState,
    /// [`ClimberState::fingerprint`] of that state.
    pub state_fingerprint: u64,
    /// [`palette_fingerprint`](crate::palette_fingerprint) of the creature's palette.
    pub palette_fingerprint: u64,
    /// The caller's hash of the rest of the scene; 0 if there is nothing else.
    pub scene_fingerprint: u64,
}

/// A snapshot from which a scene can resume after a tick.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedSnapshot {
    /// The tick, with the climber's state at its end.
    pub tick: RecordedTick,
    /// The text given to [`Recorder::snapshot`](crate::Recorder::snapshot).
    pub scene: String,
}

/// A recording that was read: its metadata, and all ticks up to where the file ends or is damaged.
///
/// [`Recording`] is a recording of one climber, [`ArenaRecording`](crate::ArenaRecording) a recording of an arena.
#[derive(Clone, Debug)]
pub struct RecordingOf<K: RecordingKind> {
    info: K::Info,
    pub(crate) source: Source,
    pub(crate) places: Places,
    ending: Ending,
    lost_at_end: u64,
}

/// A recording of one climber and its creature, by a [`Recorder`](crate::Recorder).
pub type Recording = RecordingOf<OfClimber>;

impl<K: RecordingKind> RecordingOf<K> {
    /// Reads a recording from a file of any length. Only the places of the ticks and one chunk at a time are kept in
    /// memory. Chunks may be compressed by zstd or lz4, as other programs write them, and checksums may be missing.
    ///
    /// # Errors
    /// [`RecordError::Io`] if the file cannot be read, and as [`RecordingOf::from_bytes`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordError> {
        Self::from_contents(file::open(path.as_ref())?)
    }

    /// Reads a recording from the bytes of its file.
    ///
    /// A file that was cut or damaged gives the ticks before that place; see [`RecordingOf::ending`].
    ///
    /// # Errors
    /// [`RecordError::NotMcap`] if the bytes do not begin as an MCAP file, [`RecordError::NotARecording`] if the
    /// metadata is missing or cannot be read, or if it is a recording of the other kind, [`RecordError::TickSeconds`]
    /// if its duration of a tick is not positive or not finite.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, RecordError> {
        Self::from_contents(file::read(Bytes::Memory(bytes))?)
    }

    pub(crate) fn from_contents(mut contents: Contents) -> Result<Self, RecordError> {
        let others = [
            (OfClimber::METADATA, OfClimber::READ_WITH),
            (OfArena::METADATA, OfArena::READ_WITH),
        ];
        let other = others
            .into_iter()
            .filter(|(name, _)| *name != K::METADATA)
            .find(|(name, _)| contents.metadata.contains_key(*name));
        let mut take = |name: &str| {
            contents.metadata.remove(name).ok_or_else(|| {
                RecordError::NotARecording(match other {
                    Some((_, read_with)) => read_with.to_owned(),
                    None => format!("it has no metadata named {name:?}; the {}", contents.ending),
                })
            })
        };
        let gap = take(GAP).ok();
        let lost = gap.and_then(|gap| gap.get(GAP_TICKS)?.parse().ok());
        let metadata = take(K::METADATA)?;
        let info = K::info(&metadata, take(RecordingInfo::SETTINGS)?)?;
        Ok(Self {
            info,
            places: if K::IS_ARENA {
                contents.arena
            } else {
                contents.climber
            },
            source: contents.source,
            ending: contents.ending,
            lost_at_end: lost.unwrap_or(0),
        })
    }

    /// The metadata of the recording.
    pub fn info(&self) -> &K::Info {
        &self.info
    }

    /// How the file ends.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// Number of ticks that the recorder left out after the last recorded one, because its disk was too slow.
    pub fn lost_at_end(&self) -> u64 {
        self.lost_at_end
    }

    /// The ranges of recorded ticks. Between each two of them is a gap, where the recorder left ticks out because its
    /// disk was too slow. A range after a gap begins with a saved state.
    pub fn runs(&self) -> impl Iterator<Item = RangeInclusive<u64>> + '_ {
        self.places.runs()
    }

    /// Number of ticks.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// True if there are no ticks.
    pub fn is_empty(&self) -> bool {
        self.places.len() == 0
    }

    /// The number of the first tick; `None` without ticks.
    pub fn first(&self) -> Option<u64> {
        self.places.first()
    }

    /// The number of the last tick; `None` without ticks.
    pub fn last(&self) -> Option<u64> {
        self.places.last()
    }

    /// The tick with this number.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::Message`] if it cannot be read.
    pub fn tick(&self, tick: u64) -> Result<K::Tick, RecordError> {
        self.decode(self.places.tick(tick)?)
    }

    /// All ticks, in order.
    pub fn ticks(&self) -> impl Iterator<Item = Result<K::Tick, RecordError>> + '_ {
        self.ticks_from(0)
    }

    /// The ticks from this number on, in order.
    ///
    /// A number before the first tick gives all ticks, a number after the last one gives none.
    pub fn ticks_from(&self, tick: u64) -> impl Iterator<Item = Result<K::Tick, RecordError>> + '_ {
        self.places.from(tick).map(|place| self.decode(place))
    }

    fn decode(&self, place: &Place) -> Result<K::Tick, RecordError> {
        self.source.read(place, K::TOPIC, K::tick)
    }
}

impl Recording {
    /// The last snapshot at or before a tick.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::NoSnapshot`] if it has no such
    /// snapshot.
    pub fn snapshot(&self, tick: u64) -> Result<RecordedSnapshot, RecordError> {
        let (at, place) = self.places.saved(tick)?;
        let message: Snapshot = self.source.decode(place, topics::SNAPSHOT)?;
        Ok(RecordedSnapshot {
            tick: self.tick(at)?,
            scene: message.scene,
        })
    }
}

impl RecordedTick {
    /// Decodes the message of a tick; `Err` says why it cannot be read.
    pub(crate) fn decode(message: &[u8]) -> Result<Self, String> {
        let tick = <Tick as prost::Message>::decode(message);
        let tick = tick.map_err(|error| error.to_string())?;
        let state = tick.state.to_climber();
        let state = state.map_err(|mode| format!("unknown climber mode {mode}"))?;
        if state.fingerprint() != tick.state_fingerprint {
            return Err("its state and fingerprint do not match".to_owned());
        }
        Ok(Self {
            tick: tick.tick,
            input: tick.input.into(),
            state,
            state_fingerprint: tick.state_fingerprint,
            palette_fingerprint: tick.palette_fingerprint,
            scene_fingerprint: tick.scene_fingerprint,
        })
    }
}
