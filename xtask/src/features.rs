//! The library of every crate alone, as its users build it: with no features, and with each of its features alone,
//! without warnings. What only its tests depend on is left out, so that it turns no feature on; tests, benches and
//! examples, and all features together, are linted in another step. Here dependencies that declare a newer Rust than ours
//! are refused. Nightly, the library's tests with each feature that is not on in the tests of the workspace.

use cargo_metadata::{Metadata, Package, Target, TargetKind};

use crate::build::selected;
use crate::run::{IGNORE_RUST_VERSION, cargo};

/// Features that bring in crates which declare a newer Rust than ours, and build on ours.
const NEWER_RUST: [&str; 3] = [
    "bevy_clamber/avian",
    "bevy_clamber/gltf",
    "bevy_clamber/rapier",
];

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    for package in metadata.workspace_packages() {
        let features = package.features.keys().filter(|name| *name != "default");
        let target = target(package);
        let lint = ["clippy", "--quiet", "-p", &package.name, target];
        let bare = ["--no-default-features"];
        let strict = ["--", "-D", "warnings"];
        cargo(&[&lint[..], &bare, &strict].concat())?;
        for feature in features {
            let mut with = vec!["--features", feature];
            if NEWER_RUST.contains(&format!("{}/{feature}", package.name).as_str()) {
                with.push(IGNORE_RUST_VERSION);
            }
            cargo(&[&lint[..], &bare, &with, &strict].concat())?;
        }
    }
    Ok(())
}

/// The tests of each library with each of its features that the tests of the workspace do not turn on.
pub(crate) fn test(metadata: &Metadata) -> Result<(), String> {
    let selected = selected(metadata);
    for package in metadata.workspace_packages() {
        for feature in package.features.keys().filter(|name| *name != "default") {
            // The facade has no tests in its library: its features are those of other crates.
            let tested = selected.contains(&format!("{}/{feature}", package.name));
            if !tested && package.name != "clamber" {
                let test = ["test", "--quiet", "-p", &package.name, "--lib"];
                cargo(&[&test[..], &["--features", feature]].concat())?;
            }
        }
    }
    Ok(())
}

/// What of a package is built: its library, or its program if it has none.
fn target(package: &Package) -> &'static str {
    let is_library = |target: &Target| target.kind.contains(&TargetKind::Lib);
    if package.targets.iter().any(is_library) {
        "--lib"
    } else {
        "--bins"
    }
}
