//! Every bench once, briefly: it runs, and what it checks beside measuring holds. In the profile of tests, whose
//! builds are there; the release profile would build all of Bevy again. What is released runs among the examples.

use cargo_metadata::{Metadata, TargetKind};

use crate::build::selection;
use crate::run::cargo;

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    let packages = metadata.workspace_packages();
    let targets = packages.iter().flat_map(|package| &package.targets);
    let benches = targets.filter(|target| target.kind.contains(&TargetKind::Bench));
    // By name: all of them would be the libraries' tests as well.
    let named = benches.flat_map(|bench| ["--bench", bench.name.as_str()]);
    let named: Vec<&str> = named.collect();
    cargo(
        &[
            &["test", "--quiet"][..],
            &selection(),
            &named,
            &["--", "--test"],
        ]
        .concat(),
    )
}
