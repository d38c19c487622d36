//! Rocks, tree trunks and walls on a moving creature: dynamic bodies of rapier's that collide with skin.

mod core;
mod error;
mod fit;
mod hull;
mod keep_out;
mod let_through;
mod piece;
mod pieces;
mod skin_patch;

pub use error::DebrisError;
pub use pieces::{Debris, DebrisConfig, DebrisReport};

#[cfg(test)]
mod tests;
