//! Climbers as obstacles to each other: they part, ride, land on and follow each other.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

mod carrying;
mod circles;
mod crowd;
#[path = "../climbing/held.rs"]
mod held;
mod landing;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../sizes/numbers.rs"]
mod numbers;
mod parting;
mod pushing;
mod riding;
mod room;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../climbing/scene.rs"]
mod scene;
mod weight;
