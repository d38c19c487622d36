use std::fmt;

use clamber_climber::{ClimberInput, ClimberState, Knockback};
use thiserror::Error;

use super::{ClimberMemory, ClimberTick, RecordingInfo};
use crate::kind::{Entries, Topics};
use crate::messages::{Mirror, Tick};
use crate::{OfClimber, RecordError, RecordingKind, RecordingOf, topics};

/// One tick as it was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedTick {
    /// Number of the tick.
    pub tick: u64,
    /// The climber's input in this tick.
    pub input: ClimberInput,
    /// [`StepRules::knockback`](clamber_climber::StepRules::knockback) of the climber's step in this tick; a replay has
    /// to pass it again.
    pub knockback: Option<Knockback>,
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

/// A recording of one climber and its creature, written by a [`Recorder`](crate::Recorder).
pub type Recording = RecordingOf<OfClimber>;

impl Recording {
    /// The last snapshot at or before a tick.
    ///
    /// # Errors
    /// [`RecordError::NoTick`] if the recording has no such tick, [`RecordError::NoSnapshot`] if it has no such
    /// snapshot.
    pub fn snapshot(&self, tick: u64) -> Result<RecordedSnapshot, RecordError> {
        let text = |bytes| String::from_utf8(bytes).map_err(|error| error.to_string());
        let (at, scene) = self.state(tick, text)?;
        let tick = self.tick(at)?;
        Ok(RecordedSnapshot { tick, scene })
    }
}

/// The result of one replayed tick. A game's `step` returns it to [`replay`], which compares it with the recorded tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replayed {
    /// The climber's state at the end of the tick, as the replay computed it.
    pub state: ClimberState,
    /// [`palette_fingerprint`](crate::palette_fingerprint) of the creature's palette.
    pub palette_fingerprint: u64,
    /// Hash of the rest of the scene, computed as for the recording; `None` leaves it out of the comparison.
    pub scene_fingerprint: Option<u64>,
}

/// A tick at which a replay differs from the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// The tick as recorded.
    pub recorded: RecordedTick,
    /// The tick as replayed.
    pub replayed: Replayed,
}

impl Difference {
    /// Compares the fingerprints of a recorded and a replayed tick; `None` if all are equal.
    pub fn between(recorded: &RecordedTick, replayed: &Replayed) -> Option<Self> {
        let difference = Self {
            recorded: *recorded,
            replayed: *replayed,
        };
        difference.parts().next().is_some().then_some(difference)
    }

    /// Fields of the climber's state in which replay and recording differ, such as `velocity` or
    /// `support.attachment.point`; empty if the states are equal. If an optional field is `None` in only one of the
    /// states, or the modes differ, only the first field that differs is named.
    pub fn fields(&self) -> Vec<String> {
        fields(&self.recorded.state, &self.replayed.state)
    }

    /// Names of the parts that differ: creature, climber, rest of the scene.
    fn parts(&self) -> impl Iterator<Item = &'static str> {
        let (recorded, replayed) = (&self.recorded, &self.replayed);
        let scene = replayed.scene_fingerprint;
        let pose = replayed.palette_fingerprint != recorded.palette_fingerprint;
        let climber = replayed.state.fingerprint() != recorded.state_fingerprint;
        let rest = scene.is_some_and(|scene| scene != recorded.scene_fingerprint);
        let parts = [
            ("the creature's pose", pose),
            ("the climber", climber),
            ("the rest of the scene", rest),
        ];
        let parts = parts.into_iter().filter(|(_, differs)| *differs);
        parts.map(|(name, _)| name)
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (recorded, replayed) = (&self.recorded, &self.replayed);
        let parts: Vec<&str> = self.parts().collect();
        let parts = parts.join(", ");
        writeln!(f, "tick {} differs in {parts}", recorded.tick)?;
        let fields = self.fields();
        if !fields.is_empty() {
            writeln!(f, "the climber's state differs in {}", fields.join(", "))?;
        }
        let scene = replayed.scene_fingerprint;
        let recorded_scene = scene.map(|_| recorded.scene_fingerprint);
        let palettes = [recorded.palette_fingerprint, replayed.palette_fingerprint];
        let sides = [
            ("recorded", &recorded.state, palettes[0], recorded_scene),
            ("replayed", &replayed.state, palettes[1], scene),
        ];
        for (name, state, palette, scene) in sides {
            write!(f, "{name}: palette {palette:016x}")?;
            if let Some(scene) = scene {
                write!(f, ", scene {scene:016x}")?;
            }
            writeln!(f, ", state {:016x}\n{state:#?}", state.fingerprint())?;
        }
        Ok(())
    }
}

/// Paths of the fields in which two values differ, found by comparing their debug texts line by line.
fn fields(a: &impl fmt::Debug, b: &impl fmt::Debug) -> Vec<String> {
    let [a, b] = [format!("{a:#?}"), format!("{b:#?}")];
    let alike = a.lines().count() == b.lines().count();
    let mut found = Vec::new();
    // Names of the fields that enclose the current line, each with its indentation.
    let mut around: Vec<(usize, &str)> = Vec::new();
    for (ours, theirs) in a.lines().zip(b.lines()) {
        let indentation = ours.len() - ours.trim_start().len();
        around.retain(|(outer, _)| *outer < indentation);
        if let Some((name, _)) = ours.trim_start().split_once(": ") {
            around.push((indentation, name));
        }
        if ours != theirs {
            let names: Vec<&str> = around.iter().map(|(_, name)| *name).collect();
            let path = names.join(".");
            if found.last() != Some(&path) {
                found.push(path);
            }
            if !alike {
                break;
            }
        }
    }
    found
}

/// Why a replay stopped before its end.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError<E> {
    /// A tick differs from the recording.
    #[error("{0}")]
    Differs(Box<Difference>),
    /// The recording cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Ticks are missing: the recorder left them out because its disk was too slow.
    #[error(
        "ticks are missing between {last} and {found}: replay each run of the recording by itself, from its first \
         tick's snapshot on"
    )]
    Gap {
        /// The last tick before the gap.
        last: u64,
        /// The first tick after it.
        found: u64,
    },
    /// The scene could not be stepped.
    #[error("the scene failed at tick {tick}: {error}")]
    Scene {
        /// The tick at which `step` failed.
        tick: u64,
        /// The error of `step`. It is not called `source`, so that it may be any boxed error.
        error: E,
    },
}

/// Replays ticks and compares each with the recording, up to the first difference.
///
/// `step` is called for each recorded tick in order. It brings its scene to that tick with the recorded input and
/// knockback, and returns the result. If all ticks agree, their number is returned.
///
/// Tick numbers must be consecutive. Replay each run of a recording with gaps
/// ([`Recording::runs`](crate::Recording::runs)) by itself, from the snapshot of its first tick on.
///
/// # Errors
/// [`ReplayError::Differs`] at the first tick that differs, [`ReplayError::Record`] for a tick that cannot be read,
/// [`ReplayError::Gap`] at a tick that does not follow the one before, and [`ReplayError::Scene`] if `step` fails.
pub fn replay<E>(
    ticks: impl IntoIterator<Item = Result<RecordedTick, RecordError>>,
    mut step: impl FnMut(&RecordedTick) -> Result<Replayed, E>,
) -> Result<u64, ReplayError<E>> {
    let (mut last, mut agreed) = (None, 0);
    for recorded in ticks {
        let recorded = recorded?;
        let found = recorded.tick;
        if let Some(last) = last.replace(found)
            && last.checked_add(1) != Some(found)
        {
            return Err(ReplayError::Gap { last, found });
        }
        let failed = |error| ReplayError::Scene { tick: found, error };
        let replayed = step(&recorded).map_err(failed)?;
        if let Some(difference) = Difference::between(&recorded, &replayed) {
            return Err(ReplayError::Differs(Box::new(difference)));
        }
        agreed += 1;
    }
    Ok(agreed)
}

impl RecordingKind for OfClimber {
    type Info = RecordingInfo;
    type Tick = RecordedTick;
    type Taken = ClimberTick;
    type Memory = ClimberMemory;

    const TOPICS: Topics = Topics {
        metadata: RecordingInfo::METADATA,
        read_with: "it is a recording of one climber; read it with Recording",
        index: 0,
        tick: topics::TICK,
        saved: topics::SNAPSHOT,
        is_text: true,
    };

    fn info(metadata: &Entries, settings: Entries) -> Result<RecordingInfo, RecordError> {
        RecordingInfo::from_metadata(metadata, settings)
    }

    fn tick(message: &[u8]) -> Result<(u64, RecordedTick), String> {
        let tick = <Tick as prost::Message>::decode(message);
        let tick = tick.map_err(|error| error.to_string())?;
        let state: ClimberState = tick.state.own()?;
        if state.fingerprint() != tick.state_fingerprint {
            return Err("its state and fingerprint do not match".to_owned());
        }
        let recorded = RecordedTick {
            tick: tick.tick,
            input: tick.input.own()?,
            knockback: tick.knockback.own()?,
            state,
            state_fingerprint: tick.state_fingerprint,
            palette_fingerprint: tick.palette_fingerprint,
            scene_fingerprint: tick.scene_fingerprint,
        };
        Ok((tick.tick, recorded))
    }
}

#[cfg(test)]
mod tests {
    use super::fields;
    use clamber_climber::{Climber, ClimberConfig};
    use glam::DVec3;

    #[test]
    fn differing_fields_are_named_by_their_paths() {
        let climber = Climber::new(ClimberConfig::walker(), DVec3::Y).unwrap();
        let state = *climber.state();
        assert_eq!(fields(&state, &state), [""; 0]);

        let mut other = state;
        other.velocity.x = -0.0;
        other.velocity.z = f64::MIN_POSITIVE;
        other.flying.jumping = !state.flying.jumping;
        assert_eq!(fields(&state, &other), ["velocity", "flying.jumping"]);

        // A field that is `None` in only one state has fewer lines there, so later fields cannot be compared.
        other.velocity = state.velocity;
        other.support_velocity = Some(DVec3::X);
        assert_eq!(fields(&state, &other), ["support_velocity"]);
    }
}
