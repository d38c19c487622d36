//! Scenes for the body of a climber: ground, walls, ledges and creatures, and what the player does there.
//!
//! A [`Scene`] is data and functions of time; a [`Stage`] plays it: it moves what there is, steps the climber, and
//! poses bodies in frames.

mod creatures;
mod grounds;
mod stage;
mod walls;

pub use creatures::{Mount, climb, mount};
pub use grounds::{block, flat, lift, ramp, stairs, turntable};
pub use stage::{Moment, Motion, Scene, Stage, Thing};
pub use walls::{
    all_holds, crouch, drop_off, fall, hang, knock, ledge, mantle, squeeze, step_off, wall,
};
