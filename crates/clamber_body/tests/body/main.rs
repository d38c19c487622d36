//! Scenes B12 to B20 and B23 to B25: bodies on ground, walls and creatures. The figures are the project's hero, and
//! others that play the hero's clips.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod changes;
mod climbing;
mod figures;
mod mending;
mod play;
mod walking;
