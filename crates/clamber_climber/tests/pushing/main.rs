//! Impulses of a climber on rapier's bodies: its weight, its momentum, and pushes of limited force.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod carts;
mod hanging;
mod hitting;
mod ice;
mod light;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../sizes/numbers.rs"]
mod numbers;
mod running;
mod scene;
mod weighing;
