//! Third-party models for tests and measurements. They are not part of this project: the environment variable
//! `CLAMBER_TEST_DATA` names their folder.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::{Creature, SceneError};

/// The environment variable that names the folder.
const VARIABLE: &str = "CLAMBER_TEST_DATA";

/// The path of a file of the test data. If `CLAMBER_TEST_DATA` is not set, prints to standard error that `test` was
/// skipped, and returns `None`.
///
/// # Panics
/// If the variable is set and the file is missing, so that the test is not skipped silently.
pub fn file(test: &str, name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os(VARIABLE) else {
        // Not by `eprintln`: the test harness hides its output when the test passes.
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

/// All glTF files of the test data, models and fixtures, sorted: path within the folder, and full path. If
/// `CLAMBER_TEST_DATA` is not set, prints that `test` was skipped, and returns none.
///
/// # Panics
/// As [`file()`].
pub fn gltf_files(test: &str) -> std::io::Result<Vec<(String, PathBuf)>> {
    let Some(trex) = file(test, "models/Trex.glb") else {
        return Ok(Vec::new());
    };
    let root = trex.ancestors().nth(2).unwrap_or(&trex);
    let named = files_in(root, &GLTF)?.into_iter().map(|path| {
        let name = path.strip_prefix(root).unwrap_or(&path);
        (name.to_string_lossy().replace('\\', "/"), path)
    });
    Ok(named.collect())
}

/// Extensions of the names of models.
const GLTF: [&str; 2] = ["glb", "gltf"];

/// The files of a folder and of all folders in it that have one of these extensions, sorted.
pub fn files_in(folder: &Path, extensions: &[&str]) -> std::io::Result<Vec<PathBuf>> {
    let (mut files, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = folders.pop() {
        folders.extend(read_folder(&folder, extensions, &mut files)?);
    }
    files.sort();
    Ok(files)
}

/// Adds the files of a folder that have one of these extensions. Returns the folders in it.
fn read_folder(
    folder: &Path,
    extensions: &[&str],
    files: &mut Vec<PathBuf>,
) -> std::io::Result<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let ends = |end: &&str| path.extension().is_some_and(|found| found == *end);
        if path.is_dir() {
            folders.push(path);
        } else if extensions.iter().any(ends) {
            files.push(path);
        }
    }
    Ok(folders)
}

/// The models of a folder, but not of the folders in it, sorted.
pub fn models_in(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    read_folder(folder, &GLTF, &mut files)?;
    files.sort();
    Ok(files)
}

/// The given files, or, if none are given, all files of `models/` in the folder that `CLAMBER_TEST_DATA` names, sorted.
///
/// # Errors
/// A message if no files are given, and the folder is not set, cannot be read, or has no model.
pub fn models_or(given: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    if !given.is_empty() {
        return Ok(given.to_vec());
    }
    let root = std::env::var_os(VARIABLE)
        .ok_or_else(|| format!("no models: pass files, or set {VARIABLE} to a folder"))?;
    let folder = PathBuf::from(root).join("models");
    let failed = |error: std::io::Error| format!("no models: {}: {error}", folder.display());
    let files = models_in(&folder).map_err(failed)?;
    if files.is_empty() {
        let folder = folder.display();
        return Err(format!("no models: no .glb or .gltf file in {folder}"));
    }
    Ok(files)
}

/// Models for measurements, by several makers, with 19 to 48 joints and 1 to 20 clips.
const FIVE_MODELS: [&str; 5] = [
    "Trex.glb",
    "Fox.glb",
    "CesiumMan.glb",
    "Stag.glb",
    "George.glb",
];

/// Five creatures for measurements. If `CLAMBER_TEST_DATA` is not set, prints that `test` was skipped, and returns
/// none.
///
/// # Panics
/// As [`file()`].
pub fn five_creatures(test: &str) -> Result<Vec<Creature>, SceneError> {
    let paths = five_models(test).into_iter();
    paths.map(|path| Creature::load(&path)).collect()
}

/// The files of [`five_creatures`]. If `CLAMBER_TEST_DATA` is not set, prints that `test` was skipped, and returns
/// none.
///
/// # Panics
/// As [`file()`].
pub fn five_models(test: &str) -> Vec<PathBuf> {
    let path = |name: &str| file(test, &format!("models/{name}"));
    FIVE_MODELS.into_iter().filter_map(path).collect()
}
