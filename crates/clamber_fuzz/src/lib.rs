//! Fuzz targets, stress cases and exact collision tests for clamber. Not published.
//!
//! - [`import()`], [`builder()`], [`palettes()`] and [`queries()`] are the fuzz targets. Each makes a case from any
//!   bytes, runs the library on it, checks the library's promises, and returns how much it checked. **A panic is a
//!   finding.** `fuzz/` passes them to libFuzzer; `tests/seeded.rs` runs them on seeded random bytes, with the other
//!   tests.
//! - [`ccd`] compares sweeps with exact answers, from files and from the cases that `clamber_oracle` constructs.
//! - [`stress`] makes cases that are hard in known ways, at the sizes of real creatures.
//!
//! `cargo xtask soak` runs fuzz targets, stress cases and battles for a given time.

#![expect(clippy::panic, reason = "a finding is a panic")]

mod bits;
mod builder;
mod bytes;
pub mod ccd;
mod import;
mod mesh;
mod palettes;
mod poses;
mod queries;
mod seed;
pub mod stress;

pub use builder::builder;
pub use import::import;
pub use palettes::{Palettes, palettes};
pub use queries::{Queries, queries};
pub use seed::square;
