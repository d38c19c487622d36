//! Regression tests for defects that a player would notice, here or in other games: one test each.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

mod blows;
mod common;
mod contacts;
mod corrections;
mod crushing;
mod errors;
mod frames;
mod grips;
mod impacts;
mod landings;
mod ledges;
mod modes;
mod reach;
mod room;
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
