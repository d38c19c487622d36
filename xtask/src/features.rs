//! Lints the library of each published crate alone, as its users build it: without features, and with each of its
//! features alone. Dependencies of its tests are left out, so that they turn no feature on. Another step lints tests,
//! benches and examples, and all features together. Dependencies that declare a newer Rust than ours are refused here.
//!
//! The nightly task lints each feature alone of the crates whose features bring in large dependencies. It also runs the
//! libraries' tests with each feature that is not on in the tests of the workspace.

use cargo_metadata::{Metadata, Package};

use crate::build::owned;
use crate::parts::Kind;
use crate::run::{IGNORE_RUST_VERSION, cargo};
use crate::test_run::{Packages, Targets, TestRun};

/// Features that bring in crates which declare a newer Rust than ours, but build with ours.
const NEWER_RUST: [&str; 3] = [
    "bevy_clamber/avian",
    "bevy_clamber/gltf",
    "bevy_clamber/rapier",
];

/// Crates whose features each build other parts of Bevy, rapier or wgpu. They are linted here without features, and in
/// the nightly task with each feature alone. The step `lints` has all features on.
const HEAVY: [&str; 2] = ["bevy_clamber", "clamber"];

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    for package in published(metadata) {
        lint(package, None)?;
        if !HEAVY.contains(&package.name.as_str()) {
            each(package)?;
        }
    }
    Ok(())
}

/// Lints the crates that [`check`] leaves out with each of their features alone.
pub(crate) fn check_heavy(metadata: &Metadata) -> Result<(), String> {
    let heavy = |package: &&Package| HEAVY.contains(&package.name.as_str());
    published(metadata).filter(heavy).try_for_each(each)
}

/// The packages that users can depend on.
pub(crate) fn published(metadata: &Metadata) -> impl Iterator<Item = &Package> {
    let packages = metadata.workspace_packages().into_iter();
    packages.filter(|package| package.publish.as_ref().is_none_or(|to| !to.is_empty()))
}

/// Lints a package's library with each of its features alone.
fn each(package: &Package) -> Result<(), String> {
    let features = package.features.keys().filter(|name| *name != "default");
    features
        .into_iter()
        .try_for_each(|feature| lint(package, Some(feature)))
}

/// Lints a package's library with one feature, or with none.
fn lint(package: &Package, feature: Option<&str>) -> Result<(), String> {
    let lint = ["clippy", "--quiet", "-p", &package.name, "--lib"];
    let mut with = vec!["--no-default-features"];
    if let Some(feature) = feature {
        with.extend(["--features", feature]);
        if NEWER_RUST.contains(&format!("{}/{feature}", package.name).as_str()) {
            with.push(IGNORE_RUST_VERSION);
        }
    }
    cargo(&[&lint[..], &with, &["--", "-D", "warnings"]].concat())
}

/// Runs of each library's tests with each of its features that is not on in `tests`.
pub(crate) fn runs(metadata: &Metadata, tests: &[TestRun]) -> Vec<TestRun> {
    let mut runs = Vec::new();
    for package in metadata.workspace_packages() {
        let name = package.name.as_str();
        let is_library = |run: &&TestRun| {
            let mut parts = run.covers(metadata).into_iter();
            parts.any(|part| part.package == name && part.kind == Kind::Library)
        };
        let tests: Vec<_> = tests.iter().filter(is_library).collect();
        let tested: Vec<_> = tests.iter().map(|run| run.turned_on(metadata)).collect();
        for feature in package.features.keys().filter(|name| *name != "default") {
            let feature = format!("{name}/{feature}");
            // The facade has no tests in its library: its features belong to other crates.
            if name != "clamber" && !tested.iter().any(|on| on.contains(&feature)) {
                runs.push(TestRun {
                    packages: Packages::Named(owned(&[name])),
                    features: vec![feature],
                    targets: vec![Targets::Library],
                    options: owned(&["--quiet", IGNORE_RUST_VERSION]),
                    ..TestRun::default()
                });
            }
        }
    }
    runs
}
