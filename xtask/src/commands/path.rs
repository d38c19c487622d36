//! Checks the paths and features of `cargo add` and `cargo install`.

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8Path;

/// Path of the clone from a project in a folder beside it.
const CLONE: &str = "../clamber";

/// An error if there is no package at `--path`, or if the package lacks one of the features.
pub(super) fn check(words: &[&str], main: &Metadata) -> Result<(), String> {
    let value = |option| {
        let at = words.iter().position(|word| *word == option)?;
        words.get(at + 1).copied()
    };
    let Some(path) = value("--path") else {
        return Ok(());
    };
    let path = path.strip_prefix(CLONE).unwrap_or(path).trim_matches('/');
    let is_it = |manifest: &Utf8Path| manifest == main.workspace_root.join(path).join("Cargo.toml");
    let mut packages = main.workspace_packages().into_iter();
    let package = packages.find(|package| is_it(&package.manifest_path));
    let package = package.ok_or(format!("there is no package at {path}"))?;
    let features = value("--features")
        .into_iter()
        .flat_map(|list| list.split(','));
    let mut missing = features.filter(|feature| !package.features.contains_key(*feature));
    match missing.next() {
        Some(feature) => Err(format!("{} has no feature `{feature}`", package.name)),
        None => Ok(()),
    }
}
