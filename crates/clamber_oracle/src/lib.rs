#![doc = include_str!("../README.md")]

pub mod agreement;
pub mod brute_force;
pub mod cases;
#[cfg(feature = "exact")]
pub mod exact;
pub mod golden;
mod pair;
#[cfg(feature = "exact")]
pub mod queries;

/// The version of glam whose vectors this crate uses.
pub use glam;
pub use pair::{Core, MovingPair};
