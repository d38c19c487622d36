//! Defects that players, or players of other games, would have met: one test for each, which fails if it comes back.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

mod blows;
mod common;
mod corrections;
mod crushing;
mod errors;
mod grips;
mod landings;
mod ledges;
mod reach;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../climbing/scene.rs"]
mod scene;
mod slopes;
#[allow(dead_code, unused_imports, reason = "shared with other targets")]
#[path = "../scenarios/stage/mod.rs"]
mod stage;
mod supports;
mod sweeps;
mod twice;
