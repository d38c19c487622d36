use std::fmt;

use clamber_climber::ClimberInput;
use clamber_fight::{Arena, ArenaError};

use super::{ArenaInfo, ArenaRecording, RecordedArenaTick};
use crate::RecordError;

/// A part of an arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ArenaPart {
    /// A creature, by its number.
    Creature(usize),
    /// A fighter, by its number.
    Fighter(usize),
    /// Projectiles, noises and counters.
    Rest,
}

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
    /// Compares a recorded tick with the fingerprints of another run's: [`Arena::fingerprint`] and
    /// [`Arena::part_fingerprints`]. `None` if they are equal. Names are those of `info`.
    pub fn between(
        info: &ArenaInfo,
        recorded: &RecordedArenaTick,
        fingerprint: u64,
        parts: &[u64],
    ) -> Option<Self> {
        let (creatures, fighters) = (info.creatures.len(), info.fighters.len());
        let part = |index: usize| match index.checked_sub(creatures) {
            None => (ArenaPart::Creature(index), info.creature(index)),
            Some(index) if index < fighters => (ArenaPart::Fighter(index), info.fighter(index)),
            Some(_) => (ArenaPart::Rest, "projectiles or noises".to_owned()),
        };
        let both = parts.iter().zip(&recorded.parts).enumerate();
        let differ = both.filter(|(_, (ours, theirs))| ours != theirs);
        (fingerprint != recorded.fingerprint).then(|| Self {
            recorded: recorded.clone(),
            fingerprint,
            parts: differ.map(|(index, _)| part(index)).collect(),
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
    /// The tick that it started from.
    pub from: u64,
    /// Ticks that agree, the first one included.
    pub agreed: u64,
    /// The first tick that differs; `None` if all agree.
    pub difference: Option<ArenaDifference>,
}

impl ArenaRecording {
    /// Plays a recording again and compares every tick, up to the first one that differs.
    ///
    /// `arena` is made as it was for the recording. It is brought to the last saved state at or before the tick `from`,
    /// or to the first tick. Then `step` is called with the inputs of one tick after another, and steps it over the
    /// same terrain.
    ///
    /// # Errors
    /// [`RecordError::OtherArena`] if the arena is another one, [`RecordError::NoTick`] and [`RecordError::NoSnapshot`] if there
    /// is nothing to start from, [`RecordError::Message`] for a tick that cannot be read, and [`RecordError::Arena`] if
    /// a state cannot be restored or `step` fails.
    pub fn replay(
        &self,
        arena: &mut Arena,
        from: Option<u64>,
        mut step: impl FnMut(&mut Arena, &[ClimberInput]) -> Result<(), ArenaError>,
    ) -> Result<ArenaReplay, RecordError> {
        let (recorded, found) = (self.info().assets, arena.assets());
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
        for recorded in self.ticks_from(from) {
            let recorded = recorded?;
            if recorded.tick > from {
                step(arena, &recorded.inputs)?;
            }
            if arena.fingerprint() != recorded.fingerprint {
                let (all, parts) = (arena.fingerprint(), arena.part_fingerprints());
                replay.difference = ArenaDifference::between(self.info(), &recorded, all, &parts);
                break;
            }
            replay.agreed += 1;
        }
        Ok(replay)
    }
}
