use serde::{Deserialize, Serialize};

use super::BattleError;

/// What a battle needs to go on from a tick, beside the climber's state. The rocks are no part of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BattleSnapshot {
    /// Ticks fought.
    pub tick: u64,
    /// Seconds that the creature has played, as added up.
    pub time: f64,
    /// Metres that it has walked.
    pub walked: f64,
    /// Ticks that the climber has stood on the ground.
    pub grounded: u32,
    /// How often it was dropped on the creature.
    pub drops: u32,
    /// How often it landed.
    pub landings: u32,
}

impl BattleSnapshot {
    /// As JSON; numbers read back to the same bits.
    ///
    /// # Errors
    /// [`BattleError::Snapshot`].
    pub fn to_json(&self) -> Result<String, BattleError> {
        serde_json::to_string(self).map_err(|error| BattleError::Snapshot(error.to_string()))
    }

    /// From [`BattleSnapshot::to_json`].
    ///
    /// # Errors
    /// [`BattleError::Snapshot`].
    pub fn from_json(text: &str) -> Result<Self, BattleError> {
        serde_json::from_str(text).map_err(|error| BattleError::Snapshot(error.to_string()))
    }
}
