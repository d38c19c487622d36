//! Modes of a game's own, those of the example `modes`, on obstacles without any f32, with public items only.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod all;
mod dash;
mod modes;
#[path = "../../crates/clamber_climber/tests/scenarios/stage/own.rs"]
mod own;
mod scene;
mod swim;
mod vault;
mod wall_run;
