//! Every bench once, briefly: it runs, and what it checks beside measuring holds. In the profile of tests, whose
//! builds are there; the release profile would build all of Bevy again. What is released runs among the examples.

use cargo_metadata::Metadata;

use crate::build::selection;
use crate::test_run::{Targets, TestRun};

pub(crate) fn runs(metadata: &Metadata) -> Vec<TestRun> {
    let packages = metadata.workspace_packages();
    let targets = packages.iter().flat_map(|package| &package.targets);
    let benches = targets.filter(|target| target.is_bench());
    // By name: all of them would be the libraries' tests as well.
    let named = benches.map(|bench| Targets::Bench(bench.name.clone()));
    let mut run = TestRun {
        harness: &["--test"],
        ..selection().of(named.collect())
    };
    run.options.push("--quiet".into());
    vec![run]
}
