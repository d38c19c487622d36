//! What a step asks of the world, and how a body moves in it.

mod slide;
mod stop;
mod world;

pub(crate) use slide::{Arm, Moved, Path};
pub(crate) use world::{Scratch, Touch, World};
