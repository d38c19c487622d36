#![doc = include_str!("../README.md")]

pub mod agreement;
mod answers;
pub mod brute_force;
pub mod cases;
#[cfg(feature = "fuzz")]
pub mod ccd;
#[cfg(feature = "exact")]
pub mod exact;
pub mod golden;
mod pair;
pub mod posed;
#[cfg(feature = "exact")]
pub mod queries;
#[cfg(feature = "fuzz")]
#[expect(clippy::panic, reason = "a finding is a panic")]
pub mod stress;
#[cfg(feature = "fuzz")]
#[expect(clippy::panic, reason = "a finding is a panic")]
pub mod targets;

/// The version of glam whose vectors this crate uses.
pub use glam;
pub use pair::MovingPair;
