use std::collections::BTreeSet;
use std::fmt;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, ArenaError, ArenaPart, CreatureId, FighterId, Order};

use super::{ArenaInfo, ArenaMemory, TakenArena};
use crate::kind::{Entries, Topics};
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
    /// [`Arena::part_fingerprints`] at its end.
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

/// A tick at which a replay differs from the recording.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ArenaDifference {
    /// The tick as recorded.
    pub recorded: RecordedArenaTick,
    /// The parts that differ, each with its name.
    pub parts: Vec<(ArenaPart, String)>,
}

impl ArenaDifference {
    /// Compares a recorded tick with the same tick of another run, given by [`Arena::part_fingerprints`]. `None` if all
    /// are equal. The parts get their names from `info`.
    pub fn between(
        info: &ArenaInfo,
        recorded: &RecordedArenaTick,
        parts: &[(ArenaPart, u64)],
    ) -> Option<Self> {
        if parts == recorded.parts {
            return None;
        }
        let name = |part: ArenaPart| match part {
            ArenaPart::Creature(id) => info.creature(id.0 as usize),
            ArenaPart::Fighter(id) => info.fighter(id.0 as usize),
            _ => "projectiles or noises".to_owned(),
        };
        let set = |parts: &[(ArenaPart, u64)]| parts.iter().copied().collect::<BTreeSet<_>>();
        let [ours, theirs] = [set(parts), set(&recorded.parts)];
        // Parts that only one of the two has differ, too.
        let differ = ours.symmetric_difference(&theirs).map(|(part, _)| *part);
        let differ: BTreeSet<ArenaPart> = differ.collect();
        Some(Self {
            recorded: recorded.clone(),
            parts: differ.into_iter().map(|part| (part, name(part))).collect(),
        })
    }
}

impl fmt::Display for ArenaDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.parts.iter().map(|(_, name)| name.as_str()).collect();
        write!(
            f,
            "tick {} differs: not the same {}",
            self.recorded.tick,
            names.join(", ")
        )
    }
}

/// The result of a replay of an arena.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ArenaReplay {
    /// The tick that the replay started from.
    pub from: u64,
    /// Number of ticks that agree, the first one included.
    pub agreed: u64,
    /// The first tick that differs; `None` if all agree.
    pub difference: Option<ArenaDifference>,
}

/// A recording of an arena, written by an [`ArenaRecorder`](crate::ArenaRecorder).
pub type ArenaRecording = RecordingOf<OfArena>;

impl ArenaRecording {
    /// The last saved state at or before a tick, and its tick: bytes for [`Arena::restore_bytes`].
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::NoSnapshot`] if it has no such
    /// state.
    pub fn saved(&self, tick: u64) -> Result<(u64, Vec<u8>), RecordError> {
        self.state(tick, Ok)
    }

    /// Replays the recording and compares every tick, up to the first one that differs.
    ///
    /// `arena` must have the configuration of the recorded arena and know the kinds of its creatures. It is restored to
    /// the last saved state at or before the tick `from`; `None` means the first tick. Then `step` is called with the
    /// inputs and orders of each later tick in order, and has to step the arena over the same terrain. After a gap
    /// ([`ArenaRecording::runs`]) the arena is restored to the state that was saved there.
    ///
    /// # Errors
    /// [`RecordError::OtherArena`] if the arena is another one, [`RecordError::NoTick`] and [`RecordError::NoSnapshot`]
    /// if there is no state to start from, [`RecordError::Message`] for a tick that cannot be read, and
    /// [`RecordError::Arena`] if a state cannot be restored or `step` fails.
    pub fn replay(
        &self,
        arena: &mut Arena,
        from: Option<u64>,
        mut step: impl FnMut(&mut Arena, &[ClimberInput], &[Order]) -> Result<(), ArenaError>,
    ) -> Result<ArenaReplay, RecordError> {
        let (recorded, found) = (self.info().config, arena.config_hash());
        if recorded != found {
            return Err(RecordError::OtherArena { recorded, found });
        }
        let from = from.or(self.first()).unwrap_or_default();
        let (from, saved) = self.saved(from)?;
        arena.restore_bytes(&saved)?;
        let mut replay = ArenaReplay {
            from,
            agreed: 0,
            difference: None,
        };
        let mut last = from;
        for recorded in self.ticks_from(from) {
            let recorded = recorded?;
            if recorded.tick > last && recorded.tick - last > 1 {
                // After a gap the replay continues from the state that was saved there.
                let (at, saved) = self.saved(recorded.tick)?;
                if at != recorded.tick {
                    return Err(RecordError::NoSnapshot(recorded.tick));
                }
                arena.restore_bytes(&saved)?;
            } else if recorded.tick > from {
                step(arena, &recorded.inputs, &recorded.orders)?;
            }
            last = recorded.tick;
            let parts = arena.part_fingerprints();
            replay.difference = ArenaDifference::between(self.info(), &recorded, &parts);
            if replay.difference.is_some() {
                break;
            }
            replay.agreed += 1;
        }
        Ok(replay)
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

    fn info(metadata: &Entries, settings: Entries) -> Result<ArenaInfo, RecordError> {
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
        let parts: Vec<ArenaPart> = parts.chain([ArenaPart::Rest]).collect();
        if parts.len() != tick.parts.len() {
            let [all, found] = [parts.len(), tick.parts.len()];
            return Err(format!(
                "fingerprints of {found} parts, but the arena has {all}"
            ));
        }
        let parts = parts.into_iter().zip(tick.parts).collect();
        let recorded = RecordedArenaTick {
            tick: tick.tick,
            inputs: inputs.collect::<Result<_, _>>()?,
            orders,
            parts,
        };
        Ok((tick.tick, recorded))
    }
}
