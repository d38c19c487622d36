//! Every crate with no features, and with each of its features alone, without warnings; all together
//! are linted in another step. With each feature that is neither on by default nor tested with the workspace, the
//! library's tests too.

use cargo_metadata::Metadata;

use crate::build::selected;
use crate::run::{IGNORE_RUST_VERSION, cargo};

/// Features of the plugin that newer Rust is for: their tests are another step's, or an app's.
const TESTED_ELSEWHERE: [&str; 3] = ["avian", "gltf", "rapier"];

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let selected = selected(metadata);
    for package in metadata.workspace_packages() {
        if package.features.is_empty() {
            continue;
        }
        let mut selections = vec![vec!["--no-default-features"]];
        for feature in package.features.keys().filter(|name| *name != "default") {
            selections.push(vec!["--no-default-features", "--features", feature]);
        }
        for selection in selections {
            let bare = ["clippy", "--quiet", "-p", &package.name, "--all-targets"];
            let strict = [IGNORE_RUST_VERSION, "--", "-D", "warnings"];
            cargo(&[&bare[..], &selection, &strict].concat())?;
        }
        let default = package.features.get("default").cloned().unwrap_or_default();
        for feature in package.features.keys() {
            let tested = selected.contains(&format!("{}/{feature}", package.name))
                || package.name == "bevy_clamber" && TESTED_ELSEWHERE.contains(&feature.as_str());
            // The facade has no tests in its library: its features are those of other crates.
            if feature == "default"
                || default.contains(feature)
                || tested
                || package.name == "clamber"
            {
                continue;
            }
            let test = [
                "test",
                "--quiet",
                "-p",
                &package.name,
                "--lib",
                "--features",
            ];
            // Some features bring in crates that declare a newer Rust than ours, and build on ours.
            cargo(&[&test[..], &[feature, "--ignore-rust-version"]].concat())?;
        }
    }
    Ok(())
}
