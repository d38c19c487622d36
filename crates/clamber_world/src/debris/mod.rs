//! Debris on a moving creature, such as rocks, tree trunks and walls: dynamic rapier bodies that collide with skin.

mod config;
mod corners;
mod error;
mod fit;
mod hull;
mod inner_capsule;
mod keep_out;
mod let_through;
mod patch_shape;
mod piece;
mod pieces;
mod report;
mod skin_patch;
mod snapshot;

#[cfg(test)]
pub(crate) use patch_shape::PatchShape;

pub use config::DebrisConfig;
pub use error::DebrisError;
pub use pieces::Debris;
pub use report::DebrisReport;
pub use snapshot::DebrisSnapshot;

#[cfg(test)]
mod tests;
