//! Climbers on skin, on bodies and on each other. Run one topic with `cargo test -p clamber_climber --test all
//! climbing`.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test's helpers may fail like the test"
)]

// Scenes and helpers.
mod cases;
#[path = "../golden/creature.rs"]
mod creature;
mod events;
mod held;
mod input;
mod moving;
mod numbers;
mod scene;
mod stage;

// Topics.
mod climbing;
mod configs;
mod defects;
mod exploits;
mod friends;
mod order;
mod proxies;
mod pushing;
mod random;
mod scenarios;
#[cfg(feature = "serde")]
mod serialised;
mod sizes;
