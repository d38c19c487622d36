//! What clamber's fuzz targets do with their bytes. Not published.
//!
//! Each of [`import()`], [`builder()`], [`palettes()`] and [`queries()`] makes a case of any bytes,
//! has the library deal with it, checks what must hold, and says how much there was to check. **A
//! panic is a finding.** `fuzz/` hands them to libFuzzer; `tests/seeded.rs` runs them on seeded
//! random bytes, with the other tests.
//!
//! [`ccd`] holds sweeps against exact answers, of files and of what `clamber_oracle` constructs.
//!
//! [`stress`] makes cases that are hard in known ways, at sizes as creatures have them. `cargo xtask soak` runs all of it
//! for as long as it is told.

#![expect(clippy::panic, reason = "a finding is a panic")]

mod builder;
mod bytes;
pub mod ccd;
mod import;
mod mesh;
mod palettes;
mod poses;
mod queries;
mod same;
mod seed;
pub mod stress;
mod sweeps;

pub use builder::builder;
pub use import::import;
pub use palettes::{Palettes, palettes};
pub use queries::{Queries, queries};
pub use seed::square;
