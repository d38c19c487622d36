use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::file::{self, Contents};
use crate::messages::Saved;
use crate::output::{GAP, GAP_TICKS};
use crate::places::Places;
use crate::source::{Bytes, Place, Source};
use crate::{OfArena, OfClimber, RecordError, RecordingInfo, RecordingKind};

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

/// A recording that was read: its metadata, and all ticks up to where the file ends or is damaged.
///
/// [`Recording`](crate::Recording) is a recording of one climber, [`ArenaRecording`](crate::ArenaRecording) a recording
/// of an arena.
#[derive(Clone, Debug)]
pub struct RecordingOf<K: RecordingKind> {
    info: K::Info,
    source: Source,
    places: Places,
    ending: Ending,
    lost_at_end: u64,
}

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
        let other = [OfClimber::TOPICS, OfArena::TOPICS]
            .into_iter()
            .find(|kind| {
                kind.index != K::TOPICS.index && contents.metadata.contains_key(kind.metadata)
            });
        let mut take = |name: &str| {
            contents.metadata.remove(name).ok_or_else(|| {
                RecordError::NotARecording(match other {
                    Some(kind) => kind.read_with.to_owned(),
                    None => format!("it has no metadata named {name:?}; the {}", contents.ending),
                })
            })
        };
        let gap = take(GAP).ok();
        let lost = gap.and_then(|gap| gap.get(GAP_TICKS)?.parse().ok());
        let metadata = take(K::TOPICS.metadata)?;
        let info = K::info(&metadata, take(RecordingInfo::SETTINGS)?)?;
        Ok(Self {
            info,
            places: std::mem::take(&mut contents.places[K::TOPICS.index]),
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
        let (_, tick) = self.source.read(place, K::TOPICS.tick, K::tick)?;
        Ok(tick)
    }

    /// The last saved state at or before a tick, and its tick. `make` makes the state of its bytes.
    pub(crate) fn state<T>(
        &self,
        tick: u64,
        make: impl FnOnce(Vec<u8>) -> Result<T, String>,
    ) -> Result<(u64, T), RecordError> {
        let (at, place) = self.places.saved(tick)?;
        let decode = |message: &[u8]| {
            let saved = <Saved as prost::Message>::decode(message);
            make(saved.map_err(|error| error.to_string())?.state.into())
        };
        Ok((at, self.source.read(place, K::TOPICS.saved, decode)?))
    }
}
