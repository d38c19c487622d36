use std::fmt;

use clamber_climber::ClimberState;
use thiserror::Error;

use crate::{RecordError, RecordedTick};

/// What a tick of a replay came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replayed {
    /// The climber's state.
    pub state: ClimberState,
    /// Of the creature's palette: [`palette_fingerprint`](crate::palette_fingerprint).
    pub palette_fingerprint: u64,
    /// Of whatever else was recorded; `None` to leave that out of the comparison.
    pub scene_fingerprint: Option<u64>,
}

/// The first tick at which a replay is not what was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// As recorded.
    pub recorded: RecordedTick,
    /// As replayed.
    pub replayed: Replayed,
}

impl Difference {
    /// The difference between the two, if there is one.
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

    /// What differs: creature, climber, rest of the scene.
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

/// Why a replay did not come to its end.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplayError<E> {
    /// It is not what was recorded.
    #[error("{0}")]
    Differs(Box<Difference>),
    /// The recording cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The scene failed.
    #[error("the scene failed at tick {tick}: {error}")]
    Scene {
        /// The tick.
        tick: u64,
        /// What it says; not called a source, so that it may be any boxed error.
        error: E,
    },
}

/// Hands tick after tick to `step`, which brings its scene to that tick by the recorded input, and compares
/// what came of it; ends at the first difference. Gives the number of ticks that agreed.
///
/// # Errors
/// [`ReplayError`].
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
