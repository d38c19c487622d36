//! The custom modes of the example `modes`, on obstacles that compute in f64 only, through public items only.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod all;
mod dash;
mod modes;
#[path = "../../crates/clamber_climber/tests/all/stage/own.rs"]
mod own;
mod scene;
mod swim;
mod vault;
mod wall_run;
