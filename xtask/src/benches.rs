//! Every bench once, briefly: it runs, and what it checks beside measuring holds.

use cargo_metadata::{Metadata, TargetKind};

use crate::run::cargo;

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    for package in metadata.workspace_packages() {
        for target in &package.targets {
            if target.kind.contains(&TargetKind::Bench) {
                let bench = ["bench", "--quiet", "-p", &package.name];
                // With those that are on by default: the others have to be named.
                let features = target.required_features.join(",");
                let with = ["--features", &features, "--bench", &target.name];
                cargo(&[&bench[..], &with, &["--", "--test"]].concat())?;
            }
        }
    }
    Ok(())
}
