//! Bodies in files, clips on other bodies, and bodies on ground, walls and creatures (scenes B12 to B20 and B23 to
//! B25), whose figures are the project's hero and others that play the hero's clips.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod changes;
mod climbing;
mod figures;
mod files;
mod mending;
mod play;
mod retarget;
mod walking;
