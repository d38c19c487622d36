//! Recordings are read back, by this crate and by other programs.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod arena;
mod battle;
mod damage;
mod elsewhere;
mod figure;
mod hostile;
mod knockback;
mod memory;
mod python;
mod stage;
