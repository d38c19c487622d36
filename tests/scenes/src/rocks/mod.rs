//! Rocks on a shaking giant: they fall on it, ride, roll off, and lie in the valley.

mod checks;
mod options;
mod scene;

pub use checks::{Outcome, depth};
pub use options::RocksOptions;
pub use scene::{Rocks, TICK, scatter};

use clamber_world::DebrisError;
use thiserror::Error;

use crate::CreatureError;
use crate::battle::BattleError;

/// Why the scene with the rocks failed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RocksError {
    /// The giant cannot be loaded or posed.
    #[error(transparent)]
    Creature(#[from] CreatureError),
    /// The giant cannot perform its clips.
    #[error(transparent)]
    Battle(#[from] BattleError),
    /// A rock cannot collide with the giant.
    #[error(transparent)]
    Debris(#[from] DebrisError),
}
