//! The controllers that play the scenes.

mod bodies;
mod clamber;
#[cfg(feature = "jolt")]
mod jolt;
mod rapier;

use std::error::Error;

use clamber_scenes::controllers::{Controller, Set};

/// Puts a character into a set.
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
