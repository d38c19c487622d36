//! Fights through the public interface: weapons, room, snapshots, and errors.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod afar;
mod aims;
mod arrows;
mod behind;
mod crowd;
mod debris;
mod fair;
mod joining;
mod moving;
mod orders;
mod people;
#[cfg(feature = "ggrs")]
mod rollback;
mod room;
mod snapshots;
mod stab;
mod support;
mod terrain;
mod wild;
