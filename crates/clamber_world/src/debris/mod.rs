//! Debris on a moving creature, such as rocks, tree trunks and walls: dynamic rapier bodies that collide with skin.

mod after_step;
mod config;
mod corners;
mod enclosed;
mod error;
mod fit;
mod hull;
mod inner_capsule;
mod keep_out;
mod let_through;
mod passage;
mod patch_shape;
mod piece;
mod pieces;
mod put_out;
mod report;
mod seen;
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
