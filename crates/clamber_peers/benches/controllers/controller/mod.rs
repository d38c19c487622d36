//! Who walks through the scenes.

mod bodies;
mod clamber;
#[cfg(feature = "jolt")]
mod jolt;
mod rapier;

use std::error::Error;

use glam::DVec3;

use crate::set::{Input, Set};

/// A character in a world of its own.
pub(crate) trait Controller {
    /// Takes the world to a time, and the character with it. Gives the microseconds of the character's part.
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, Box<dyn Error>>;

    /// The middle of its lower ball: [`RADIUS`](crate::set::RADIUS) above its feet.
    fn position(&self) -> DVec3;

    /// Whether it says that it stands on something.
    fn stands(&self) -> bool;
}

/// Puts a character on a set.
type Make = fn(&Set) -> Result<Box<dyn Controller>, Box<dyn Error>>;

/// A way to move a character.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    /// It has to pass every scene, or the bench fails.
    pub(crate) is_ours: bool,
    pub(crate) make: Make,
}

/// All of them; ours first.
pub(crate) fn all() -> Vec<Entry> {
    let mut all = Vec::new();
    all.extend(clamber::ENTRIES);
    all.extend(rapier::ENTRIES);
    #[cfg(feature = "jolt")]
    all.extend(jolt::ENTRIES);
    all
}
