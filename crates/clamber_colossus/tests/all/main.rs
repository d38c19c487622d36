//! Tests of creatures and their brains through the public interface.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod animals;
mod attacks;
mod between;
mod brain;
mod carried;
mod clips;
mod edges;
mod elsewhere;
mod feet;
mod foresight;
mod giant;
mod legs;
mod mouths;
mod ordered;
mod plates;
mod proposed;
mod ranged;
mod ranged_elsewhere;
mod senses;
mod sizes;
mod sleep;
mod support;
mod traps;
mod trex;
mod undecided;
mod walls;
