use std::fmt;

use clamber_climber::ClimberState;
use thiserror::Error;

use crate::{RecordError, RecordedTick};

/// What a game's `step` returns to [`replay`]: the result of one replayed tick, to compare with the recorded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replayed {
    /// The climber's state at the end of the tick, as the replay has computed it.
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

    /// Names of what differs: creature, climber, rest of the scene.
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
    /// The scene could not be stepped.
    #[error("the scene failed at tick {tick}: {error}")]
    Scene {
        /// The tick.
        tick: u64,
        /// The error of `step`. It is not called `source`, so that it may be any boxed error.
        error: E,
    },
}

/// Replays ticks and compares each with the recording, up to the first difference.
///
/// `step` is called for one recorded tick after another. It brings its scene to that tick with the recorded input, and
/// returns the result. If all ticks agree, their number is returned.
///
/// # Errors
/// [`ReplayError::Differs`] at the first tick that differs, [`ReplayError::Record`] for a tick that cannot be read, and
/// [`ReplayError::Scene`] if `step` fails.
pub fn replay<E>(
    ticks: impl IntoIterator<Item = Result<RecordedTick, RecordError>>,
    mut step: impl FnMut(&RecordedTick) -> Result<Replayed, E>,
) -> Result<u64, ReplayError<E>> {
    let mut agreed = 0;
    for recorded in ticks {
        let recorded = recorded?;
        let replayed = step(&recorded).map_err(|error| ReplayError::Scene {
            tick: recorded.tick,
            error,
        })?;
        if let Some(difference) = Difference::between(&recorded, &replayed) {
            return Err(ReplayError::Differs(Box::new(difference)));
        }
        agreed += 1;
    }
    Ok(agreed)
}
