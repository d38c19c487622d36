//! Scenes B12 to B20 and B23 to B25: a body on ground, walls and creatures, with the project's hero and with other
//! figures that play the hero's clips.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod changes;
mod climbing;
mod figures;
mod mending;
mod play;
mod walking;
