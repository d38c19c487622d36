//! Every bench once, briefly: it runs, and what it checks beside measuring holds.

use cargo_metadata::{Metadata, TargetKind};

use crate::run::cargo;

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    for package in metadata.workspace_packages() {
        for target in &package.targets {
            if target.kind.contains(&TargetKind::Bench) {
                let bench = ["bench", "--quiet", "-p", &package.name];
                cargo(&[&bench[..], &["--bench", &target.name, "--", "--test"]].concat())?;
            }
        }
    }
    Ok(())
}
