use std::fmt;

use clamber_climber::ClimberState;
use thiserror::Error;

use super::RecordedTick;
use crate::RecordError;

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
        let scene = replayed.scene_fingerprint;
        let equal = replayed.state.fingerprint() == recorded.state_fingerprint
            && replayed.palette_fingerprint == recorded.palette_fingerprint
            && scene.is_none_or(|scene| scene == recorded.scene_fingerprint);
        (!equal).then_some(Self {
            recorded: *recorded,
            replayed: *replayed,
        })
    }

    /// Fields of the climber's state in which replay and recording differ, such as `velocity` or
    /// `support.attachment.point`; empty if the states are equal. If an optional field is `None` in only one of the
    /// states, or the modes differ, only the first field that differs is named.
    pub fn fields(&self) -> Vec<String> {
        fields(&self.recorded.state, &self.replayed.state)
    }

    /// Names of the parts that differ: creature, climber, rest of the scene.
    fn what(&self) -> String {
        let (recorded, replayed) = (&self.recorded, &self.replayed);
        let scene = replayed.scene_fingerprint;
        let parts = [
            (
                "the creature's pose",
                replayed.palette_fingerprint != recorded.palette_fingerprint,
            ),
            (
                "the climber",
                replayed.state.fingerprint() != recorded.state_fingerprint,
            ),
            (
                "the rest of the scene",
                scene.is_some_and(|scene| scene != recorded.scene_fingerprint),
            ),
        ];
        let names = parts.iter().filter(|(_, differs)| *differs);
        names.map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (recorded, replayed) = (&self.recorded, &self.replayed);
        writeln!(f, "tick {} differs in {}", recorded.tick, self.what())?;
        let fields = self.fields();
        if !fields.is_empty() {
            writeln!(f, "the climber's state differs in {}", fields.join(", "))?;
        }
        let scene = replayed.scene_fingerprint;
        let sides = [
            (
                "recorded",
                &recorded.state,
                recorded.palette_fingerprint,
                scene.map(|_| recorded.scene_fingerprint),
            ),
            (
                "replayed",
                &replayed.state,
                replayed.palette_fingerprint,
                scene,
            ),
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
/// `step` is called for each recorded tick in order. It brings its scene to that tick with the recorded input, and
/// returns the result. If all ticks agree, their number is returned.
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
    let mut last: Option<u64> = None;
    let (agreed, difference) = compare(ticks, |recorded| {
        let found = recorded.tick;
        if let Some(last) = last
            .replace(found)
            .filter(|last| last.checked_add(1) != Some(found))
        {
            return Err(ReplayError::Gap { last, found });
        }
        let replayed = step(recorded).map_err(|error| ReplayError::Scene {
            tick: recorded.tick,
            error,
        })?;
        Ok::<_, ReplayError<E>>(Difference::between(recorded, &replayed))
    })?;
    match difference {
        Some(difference) => Err(ReplayError::Differs(Box::new(difference))),
        None => Ok(agreed),
    }
}

/// Replays ticks up to the first one that differs. `step` replays a tick and returns its difference. Returns the number
/// of ticks that agree, and the difference.
pub(crate) fn compare<T, D, E: From<RecordError>>(
    ticks: impl IntoIterator<Item = Result<T, RecordError>>,
    mut step: impl FnMut(&T) -> Result<Option<D>, E>,
) -> Result<(u64, Option<D>), E> {
    let mut agreed = 0;
    for recorded in ticks {
        if let Some(difference) = step(&recorded?)? {
            return Ok((agreed, Some(difference)));
        }
        agreed += 1;
    }
    Ok((agreed, None))
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
