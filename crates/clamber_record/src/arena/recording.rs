use std::ops::RangeInclusive;
use std::path::Path;

use clamber_climber::ClimberInput;
use clamber_fight::{ArenaPart, CreatureId, FighterId, Order};

use super::ArenaInfo;
use crate::file::{self, Contents};
use crate::messages::{ArenaSnapshot, ArenaTick};
use crate::places::Places;
use crate::source::{Bytes, Place, Source};
use crate::{Ending, RecordError, RecordingInfo, topics};

/// A tick of an arena as it was recorded.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedArenaTick {
    /// Number of the tick.
    pub tick: u64,
    /// The inputs of the step that led to it, by fighter; none for the first tick of a recording.
    pub inputs: Vec<ClimberInput>,
    /// The orders of that step.
    pub orders: Vec<Order>,
    /// [`Arena::fingerprint`](clamber_fight::Arena::fingerprint) at its end.
    pub fingerprint: u64,
    /// [`Arena::part_fingerprints`](clamber_fight::Arena::part_fingerprints) at its end.
    pub parts: Vec<(ArenaPart, u64)>,
}

impl RecordedArenaTick {
    /// What a message says, or what is wrong with it.
    pub(crate) fn decode(message: &[u8]) -> Result<Self, String> {
        let tick = prost::Message::decode(message);
        Self::from_message(tick.map_err(|error| error.to_string())?)
    }

    fn from_message(tick: ArenaTick) -> Result<Self, String> {
        let orders = match &tick.orders[..] {
            [] => Vec::new(),
            orders => Order::from_bytes(orders).map_err(|error| error.to_string())?,
        };
        let creatures = tick.creatures.iter().copied().map(CreatureId);
        let fighters = tick.fighters.iter().copied().map(FighterId);
        let parts = creatures.map(ArenaPart::Creature);
        let parts = parts.chain(fighters.map(ArenaPart::Fighter));
        let parts = parts.chain([ArenaPart::Rest]).zip(tick.parts);
        Ok(Self {
            tick: tick.tick,
            inputs: tick.inputs.into_iter().map(Into::into).collect(),
            orders,
            fingerprint: tick.fingerprint,
            parts: parts.collect(),
        })
    }

    /// The numbers of the fighters at its end, to whom the inputs of the next step belong.
    pub fn fighters(&self) -> impl Iterator<Item = usize> + '_ {
        self.parts.iter().filter_map(|(part, _)| match part {
            ArenaPart::Fighter(FighterId(number)) => Some(*number as usize),
            _ => None,
        })
    }
}

/// A recording of an arena that was read: its metadata, and all ticks up to where the file ends or is damaged.
#[derive(Clone, Debug)]
pub struct ArenaRecording {
    info: ArenaInfo,
    source: Source,
    places: Places,
    ending: Ending,
}

impl ArenaRecording {
    /// Reads a recording from a file of any length, as [`Recording::open`](crate::Recording::open) does.
    ///
    /// # Errors
    /// [`RecordError::Io`] if the file cannot be read, and as [`ArenaRecording::from_bytes`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, RecordError> {
        Self::from_contents(file::open(path.as_ref())?)
    }

    /// Reads a recording from the bytes of its file.
    ///
    /// A file that was cut or damaged gives the ticks before that place; see [`ArenaRecording::ending`].
    ///
    /// # Errors
    /// [`RecordError::NotMcap`] if the bytes do not begin as an MCAP file, [`RecordError::NotARecording`] if the
    /// metadata is missing or cannot be read, [`RecordError::TickSeconds`] if its duration of a tick is not positive or
    /// not finite.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, RecordError> {
        Self::from_contents(file::read(Bytes::Memory(bytes))?)
    }

    pub(crate) fn from_contents(mut contents: Contents) -> Result<Self, RecordError> {
        let of_one = contents.metadata.contains_key(RecordingInfo::METADATA);
        let mut take = |name: &str| {
            contents.metadata.remove(name).ok_or_else(|| {
                RecordError::NotARecording(if of_one {
                    "it is a recording of one climber; read it with Recording".to_owned()
                } else {
                    format!("it has no metadata named {name:?}; the {}", contents.ending)
                })
            })
        };
        let metadata = take(ArenaInfo::METADATA)?;
        let info = ArenaInfo::from_metadata(&metadata, take(RecordingInfo::SETTINGS)?)?;
        Ok(Self {
            info,
            source: contents.source,
            places: contents.arena,
            ending: contents.ending,
        })
    }

    /// The metadata of the recording.
    pub fn info(&self) -> &ArenaInfo {
        &self.info
    }

    /// How the file ends.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// The ticks that it has: ranges, and between each two of them a gap, where the recorder has left ticks out since its disk
    /// was too slow. A range after a gap begins with a saved state.
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

    /// Number of the first tick; `None` without ticks.
    pub fn first(&self) -> Option<u64> {
        self.places.first()
    }

    /// Number of the last tick; `None` without ticks.
    pub fn last(&self) -> Option<u64> {
        self.places.last()
    }

    /// The ticks from this number on, in order: all for a number before the first one, none for a number after the last
    /// one.
    pub fn ticks_from(
        &self,
        tick: u64,
    ) -> impl Iterator<Item = Result<RecordedArenaTick, RecordError>> + '_ {
        let ticks = self.places.from(tick);
        ticks.map(|place| self.decode_tick(place))
    }

    /// The last saved state at or before a tick, and its tick: bytes for
    /// [`Arena::restore_bytes`](clamber_fight::Arena::restore_bytes).
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::NoSnapshot`] if it has no such
    /// state.
    pub fn saved(&self, tick: u64) -> Result<(u64, Vec<u8>), RecordError> {
        let (at, place) = self.places.saved(tick)?;
        Ok((at, self.decode_saved(place)?.state.to_vec()))
    }

    fn decode_tick(&self, place: &Place) -> Result<RecordedArenaTick, RecordError> {
        let tick: ArenaTick = self.source.decode(place, topics::ARENA)?;
        RecordedArenaTick::from_message(tick).map_err(|reason| RecordError::Message {
            at: self.source.offset(place),
            topic: topics::ARENA,
            reason,
        })
    }

    fn decode_saved(&self, place: &Place) -> Result<ArenaSnapshot, RecordError> {
        self.source.decode(place, topics::ARENA_SNAPSHOT)
    }
}
