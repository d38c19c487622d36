//! Rocks, tree trunks and walls on a moving creature: dynamic bodies of rapier's that collide with skin.

mod config;
mod error;
mod fit;
mod hull;
mod inner_capsule;
mod keep_out;
mod let_through;
mod patch_mesh;
mod piece;
mod pieces;
mod report;
mod skin_patch;

pub use config::DebrisConfig;
pub use error::DebrisError;
pub use pieces::Debris;
pub use report::DebrisReport;

#[cfg(test)]
mod tests;
