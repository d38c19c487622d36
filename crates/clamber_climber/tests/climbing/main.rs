//! Gripping, climbing, hanging, ledges, and being shaken off.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod catching;
mod corners;
mod crushing;
mod feet;
mod gripping;
mod hanging;
mod held;
mod ledges;
mod lying;
#[path = "../sizes/moving.rs"]
mod moving;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../sizes/numbers.rs"]
mod numbers;
mod scene;
mod shaking;
