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

/// Runs the test of a defect that is not mended yet: it has to fail, so that the mend takes this call along.
fn open(what: &str, test: fn()) {
    let holds = std::panic::catch_unwind(test).is_ok();
    assert!(!holds, "{what}: holds, and is open no more");
    println!("OPEN {what}");
}
