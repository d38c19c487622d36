use serde::{Deserialize, Serialize};

use super::{BattleError, PerformerState, Tally};

/// The state of a battle at a tick, besides the climber's state. It does not include the rocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BattleSnapshot {
    /// Number of ticks so far.
    pub tick: u64,
    /// The creature's state.
    pub creature: PerformerState,
    /// Consecutive ticks for which a rider has been on the ground.
    pub grounded: u32,
    /// How often a rider was dropped on the creature.
    pub drops: u32,
    /// How often the climber landed.
    pub landings: u32,
    /// How often a climber died or was lost, and began again.
    pub deaths: u32,
    /// What was shot, struck and killed.
    pub tally: Tally,
}

impl BattleSnapshot {
    /// Writes the snapshot as JSON. Its numbers read back to the same bits.
    ///
    /// # Errors
    /// [`BattleError::Snapshot`].
    pub fn to_json(&self) -> Result<String, BattleError> {
        serde_json::to_string(self).map_err(|error| BattleError::Snapshot(error.to_string()))
    }

    /// Reads a snapshot that [`BattleSnapshot::to_json`] wrote.
    ///
    /// # Errors
    /// [`BattleError::Snapshot`].
    pub fn from_json(text: &str) -> Result<Self, BattleError> {
        serde_json::from_str(text).map_err(|error| BattleError::Snapshot(error.to_string()))
    }
}
