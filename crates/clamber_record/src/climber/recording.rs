use std::collections::BTreeMap;

use clamber_climber::{ClimberInput, ClimberState};

use super::{ClimberMemory, ClimberTick, RecordingInfo};
use crate::kind::Topics;
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

    fn info(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<RecordingInfo, RecordError> {
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
            state,
            state_fingerprint: tick.state_fingerprint,
            palette_fingerprint: tick.palette_fingerprint,
            scene_fingerprint: tick.scene_fingerprint,
        };
        Ok((tick.tick, recorded))
    }
}
