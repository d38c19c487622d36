//! Climbers that rapier's dynamic bodies collide with, by their proxies.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod falling;
mod heavy;
mod memory;
mod pushing;
mod restoring;
mod scene;
#[allow(dead_code, reason = "shared with other targets")]
#[path = "../climbing/scene.rs"]
mod skin;
mod skins;
mod striking;
