use serde::{Deserialize, Serialize};

use super::BattleError;

/// The state of a battle at a tick, besides the climber's state. It does not include the rocks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BattleSnapshot {
    /// Number of ticks so far.
    pub tick: u64,
    /// Time of the creature's clips, seconds: the sum of the ticks' lengths.
    pub time: f64,
    /// Distance that the creature has walked, metres.
    pub walked: f64,
    /// Consecutive ticks for which a rider has been on the ground.
    pub grounded: u32,
    /// How often the climber was dropped on the creature.
    pub drops: u32,
    /// How often the climber landed.
    pub landings: u32,
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
