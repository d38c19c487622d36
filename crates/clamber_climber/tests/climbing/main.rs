//! Gripping, climbing, hanging, ledges, and being shaken off.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod corners;
mod crushing;
mod gripping;
mod hanging;
mod ledges;
mod scene;
mod shaking;
