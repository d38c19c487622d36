use std::fmt;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, ArenaError, ArenaPart, Order};

use super::{ArenaInfo, ArenaRecording, RecordedArenaTick};
use crate::RecordError;
use crate::climber::compare;

/// A tick at which a replay differs from the recording.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ArenaDifference {
    /// The tick as recorded.
    pub recorded: RecordedArenaTick,
    /// Fingerprint of the arena as replayed.
    pub fingerprint: u64,
    /// The parts that differ, each with its name.
    pub parts: Vec<(ArenaPart, String)>,
}

impl ArenaDifference {
    /// Compares a recorded tick with the same tick of another run, given by [`Arena::fingerprint`] and
    /// [`Arena::part_fingerprints`]. `None` if the fingerprints are equal. The parts get their names from `info`.
    pub fn between(
        info: &ArenaInfo,
        recorded: &RecordedArenaTick,
        fingerprint: u64,
        parts: &[(ArenaPart, u64)],
    ) -> Option<Self> {
        let name = |part: ArenaPart| match part {
            ArenaPart::Creature(id) => info.creature(id.0 as usize),
            ArenaPart::Fighter(id) => info.fighter(id.0 as usize),
            _ => "projectiles or noises".to_owned(),
        };
        // Parts that only one of the two has differ, too.
        let [ours, theirs] = [parts, &recorded.parts];
        let mut differ: Vec<ArenaPart> = Vec::new();
        for (one, other) in [(ours, theirs), (theirs, ours)] {
            let missing = one.iter().filter(|part| !other.contains(part));
            differ.extend(missing.map(|(part, _)| *part));
        }
        differ.sort_unstable();
        differ.dedup();
        (fingerprint != recorded.fingerprint).then(|| Self {
            recorded: recorded.clone(),
            fingerprint,
            parts: differ.into_iter().map(|part| (part, name(part))).collect(),
        })
    }
}

impl fmt::Display for ArenaDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.parts.iter().map(|(_, name)| name.as_str()).collect();
        write!(
            f,
            "tick {} differs: not the same {}; fingerprint {:016x} became {:016x}",
            self.recorded.tick,
            names.join(", "),
            self.recorded.fingerprint,
            self.fingerprint
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

impl ArenaRecording {
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
        let mut last = from;
        let (agreed, difference) = compare(self.ticks_from(from), |recorded| {
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
            let all = arena.fingerprint();
            if all == recorded.fingerprint {
                return Ok::<_, RecordError>(None);
            }
            let parts = arena.part_fingerprints();
            let info = self.info();
            Ok(ArenaDifference::between(info, recorded, all, &parts))
        })?;
        Ok(ArenaReplay {
            from,
            agreed,
            difference,
        })
    }
}
