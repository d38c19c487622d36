//! Thirty scenes for character controllers, on ground that moves: platforms, walls that push, slopes, steps and edges.
//!
//! They follow the scenarios of `clamber_climber` (`tests/all/scenarios/table.rs`) that a controller on rigid bodies
//! can be asked at all, with the same numbers. A scene is made of solids that move as functions of time ([`Set`]), an
//! input for each tick, and an error in metres with its bound ([`Scene`]). [`play`] steps any [`Controller`] through
//! one: it comes to rest for a second, then everything moves.
//!
//! The bench `controllers` of `clamber_peers` plays them with clamber's climber, rapier's and Jolt's controllers.

mod ground;
mod platforms;
mod play;
mod set;
mod solid;
mod walls;

pub use play::{Controller, Outcome, Scene, Seen, all, play};
pub use set::{
    HEIGHT, IDLE, Input, Motion, PADDING, Piece, RADIUS, SNAP, STEP, Set, TICK, radians, shifted,
    turned,
};
pub use solid::{Mesh, Solid};
