//! Every crate with no features, and with each of its features alone. All together are linted in
//! another step.

use cargo_metadata::Metadata;

use crate::run::cargo;

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    for package in metadata.workspace_packages() {
        if package.features.is_empty() {
            continue;
        }
        let bare = [
            "check",
            "--quiet",
            "-p",
            &package.name,
            "--no-default-features",
        ];
        cargo(&bare)?;
        for feature in package.features.keys().filter(|name| *name != "default") {
            cargo(&[&bare[..], &["--features", feature]].concat())?;
        }
    }
    Ok(())
}
