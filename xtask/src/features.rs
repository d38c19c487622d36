//! Lints the library of each published crate alone, as its users build it: without features, and with each of its
//! features alone. Dependencies of its tests are left out, so that they turn no feature on. Another step lints tests,
//! benches and examples, and all features together. Dependencies that declare a newer Rust than ours are refused here.

use cargo_metadata::{Metadata, Package};

use crate::call::{Part, ask};
use crate::process::{IGNORE_RUST_VERSION, cargo};
use crate::workspace::published;

/// Features that bring in crates which declare a newer Rust than ours, but build with ours.
const NEWER_RUST: &str = "bevy_clamber/avian bevy_clamber/gltf bevy_clamber/rapier";

/// Crates whose features each build other parts of Bevy, rapier or wgpu. CI lints them without features, and the
/// nightly task with each feature alone. The step `lints` has all features on.
const HEAVY: [&str; 2] = ["bevy_clamber", "clamber"];

/// Lints all crates without features, and all but the heavy ones with each feature alone.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let mut packages = published(metadata).into_iter();
    packages.try_for_each(|package| lint(&package.name, ""))?;
    lint_each(metadata, false)
}

/// Lints the heavy crates with each of their features alone.
pub(crate) fn check_heavy(metadata: &Metadata) -> Result<(), String> {
    lint_each(metadata, true)
}

fn lint_each(metadata: &Metadata, is_heavy: bool) -> Result<(), String> {
    let mut packages = published(metadata);
    packages.retain(|package| HEAVY.contains(&package.name.as_str()) == is_heavy);
    let mut features = packages.into_iter().flat_map(features);
    features.try_for_each(|(name, feature)| lint(name, &feature))
}

/// The features of a package, as package and `package/feature`.
fn features(package: &Package) -> impl Iterator<Item = (&str, String)> {
    let features = package.features.keys();
    let features = features.filter(|feature| *feature != "default");
    features.map(|feature| (package.name.as_str(), format!("{}/{feature}", package.name)))
}

/// Lints a package's library with one feature, or with none if it is empty.
fn lint(name: &str, feature: &str) -> Result<(), String> {
    let mut line = format!("clippy --quiet -p {name} --lib --no-default-features");
    if !feature.is_empty() {
        line += &format!(" --features {feature}");
    }
    if NEWER_RUST.split(' ').any(|known| known == feature) {
        line += &format!(" {IGNORE_RUST_VERSION}");
    }
    cargo(&(line + " -- -D warnings"))
}

/// The calls of each package's tests with each of its features that is not on in `tests`. The facade's features belong
/// to other crates, which have their own tests.
pub(crate) fn runs(metadata: &Metadata, tests: &[String]) -> Result<Vec<String>, String> {
    let packages = metadata.workspace_packages().into_iter();
    let mut missing: Vec<(&str, String)> = packages.flat_map(features).collect();
    missing.retain(|(name, _)| *name != "clamber");
    for line in tests {
        let call = ask(&metadata.workspace_root, line)?;
        missing.retain(|(name, feature)| {
            let is_tested = call.parts.contains(&Part::new(name, "lib", name));
            !is_tested || !call.features.contains(feature)
        });
    }
    let line = |(name, feature)| {
        format!("test -p {name} --features {feature} --quiet --lib --tests {IGNORE_RUST_VERSION}")
    };
    Ok(missing.into_iter().map(line).collect())
}
