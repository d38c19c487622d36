use std::collections::BTreeMap;

use clamber_climber::ClimberInput;
use clamber_fight::{ArenaPart, CreatureId, FighterId, Order};

use super::{ArenaInfo, ArenaMemory, TakenArena};
use crate::kind::Topics;
use crate::messages::{ArenaTick, Mirror};
use crate::{OfArena, RecordError, RecordingKind, RecordingOf, topics};

/// The largest message of a tick that is written and read, bytes (2 MiB): enough for 18,000 fighters. It bounds memory:
/// an input may take two bytes in a message, but more than a hundred in memory.
pub(crate) const LARGEST_TICK: usize = 2 << 20;

/// A tick of an arena as it was recorded.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedArenaTick {
    /// Number of the tick.
    pub tick: u64,
    /// The inputs of the step that led to it, in the order of the fighters; empty for the first tick of a recording.
    pub inputs: Vec<ClimberInput>,
    /// The orders of that step.
    pub orders: Vec<Order>,
    /// [`Arena::fingerprint`](clamber_fight::Arena::fingerprint) at its end.
    pub fingerprint: u64,
    /// [`Arena::part_fingerprints`](clamber_fight::Arena::part_fingerprints) at its end.
    pub parts: Vec<(ArenaPart, u64)>,
}

impl RecordedArenaTick {
    /// The numbers of the fighters at its end. The inputs of the next step belong to them, in this order.
    pub fn fighters(&self) -> impl Iterator<Item = usize> + '_ {
        self.parts.iter().filter_map(|(part, _)| match part {
            ArenaPart::Fighter(FighterId(number)) => Some(*number as usize),
            _ => None,
        })
    }
}

/// A recording of an arena, written by an [`ArenaRecorder`](crate::ArenaRecorder).
pub type ArenaRecording = RecordingOf<OfArena>;

impl ArenaRecording {
    /// The last saved state at or before a tick, and its tick: bytes for
    /// [`Arena::restore_bytes`](clamber_fight::Arena::restore_bytes).
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::NoSnapshot`] if it has no such
    /// state.
    pub fn saved(&self, tick: u64) -> Result<(u64, Vec<u8>), RecordError> {
        self.state(tick, Ok)
    }
}

impl RecordingKind for OfArena {
    type Info = ArenaInfo;
    type Tick = RecordedArenaTick;
    type Taken = TakenArena;
    type Memory = ArenaMemory;

    const TOPICS: Topics = Topics {
        metadata: ArenaInfo::METADATA,
        read_with: "it is a recording of an arena; read it with ArenaRecording",
        index: 1,
        tick: topics::ARENA,
        saved: topics::ARENA_SNAPSHOT,
        is_text: false,
    };

    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<ArenaInfo, RecordError> {
        ArenaInfo::from_metadata(metadata, settings)
    }

    fn tick(message: &[u8]) -> Result<(u64, RecordedArenaTick), String> {
        if message.len() > LARGEST_TICK {
            return Err("a tick of more than 2 MiB".to_owned());
        }
        let tick = <ArenaTick as prost::Message>::decode(message);
        let tick = tick.map_err(|error| error.to_string())?;
        let orders = match &tick.orders[..] {
            [] => Vec::new(),
            orders => Order::from_bytes(orders).map_err(|error| error.to_string())?,
        };
        let inputs = tick.inputs.iter().map(Mirror::own);
        let creatures = tick.creatures.iter().copied().map(CreatureId);
        let fighters = tick.fighters.iter().copied().map(FighterId);
        let parts = creatures.map(ArenaPart::Creature);
        let parts = parts.chain(fighters.map(ArenaPart::Fighter));
        let parts = parts.chain([ArenaPart::Rest]).zip(tick.parts);
        let recorded = RecordedArenaTick {
            tick: tick.tick,
            inputs: inputs.collect::<Result<_, _>>()?,
            orders,
            fingerprint: tick.fingerprint,
            parts: parts.collect(),
        };
        Ok((tick.tick, recorded))
    }
}
