//! The character controllers.

mod bodies;
mod clamber;
#[cfg(feature = "jolt")]
mod jolt;
mod rapier;

use std::error::Error;

use clamber_scenes::controllers::{Controller, Set};

/// A function that puts a character on a set.
type Make = fn(&Set) -> Result<Box<dyn Controller>, Box<dyn Error>>;

/// A controller's name, and the function that makes it.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    /// True for clamber's controllers: the bench fails if one of them fails in a scene.
    pub(crate) is_ours: bool,
    pub(crate) make: Make,
}

/// All controllers; clamber's come first.
pub(crate) fn all() -> Vec<Entry> {
    let mut all = Vec::new();
    all.extend(clamber::ENTRIES);
    all.extend(rapier::ENTRIES);
    #[cfg(feature = "jolt")]
    all.extend(jolt::ENTRIES);
    all
}
