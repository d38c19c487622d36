//! Third-party models for tests and measurements. They are no part of this project: their folder
//! is named by `CLAMBER_TEST_DATA`.

use std::io::Write;
use std::path::PathBuf;

use crate::{Creature, CreatureError};

/// The environment variable that names the folder.
pub const VARIABLE: &str = "CLAMBER_TEST_DATA";

/// A file of the test data. Without [`VARIABLE`], says on standard error that `test` was skipped,
/// and gives `None`.
///
/// # Panics
/// If the variable is set and the file is missing: a test that was to run must not pass unseen.
pub fn file(test: &str, name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os(VARIABLE) else {
        // Not by `eprintln`, whose output passing tests swallow.
        let line = format!("SKIPPED {test}: set {VARIABLE} to the folder that holds {name}\n");
        let _ = std::io::stderr().write_all(line.as_bytes());
        return None;
    };
    let path = PathBuf::from(folder).join(name);
    assert!(
        path.is_file(),
        "{VARIABLE} is set, but {} is missing",
        path.display()
    );
    Some(path)
}

/// Models of several makers, with 19 to 48 joints and 1 to 20 clips, to measure on.
const FIVE_MODELS: [&str; 5] = [
    "Trex.glb",
    "Fox.glb",
    "CesiumMan.glb",
    "Stag.glb",
    "George.glb",
];

/// Five models to measure on; none, said on standard error, without [`VARIABLE`].
///
/// # Errors
/// [`CreatureError`] if one cannot be loaded.
///
/// # Panics
/// As [`file()`].
pub fn five_creatures(test: &str) -> Result<Vec<Creature>, CreatureError> {
    let paths = FIVE_MODELS
        .iter()
        .map(|name| file(test, &format!("models/{name}")));
    paths.flatten().map(|path| Creature::load(&path)).collect()
}
