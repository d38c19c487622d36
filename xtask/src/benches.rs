//! Every bench. In CI once, briefly: it runs, and what it checks beside measuring holds. In the profile of tests, whose
//! builds are there; the release profile would build all of Bevy again. What is released runs among the examples. At night
//! whole, in the release profile: a bench fails if a bound is missed by far.

use cargo_metadata::Metadata;

use crate::build::{owned, selection};
use crate::test_run::{Profile, Targets, TestRun};

/// Each once, briefly.
pub(crate) fn runs(metadata: &Metadata) -> Vec<TestRun> {
    let mut run = TestRun {
        harness: &["--test"],
        ..all(metadata)
    };
    run.options.push("--quiet".into());
    vec![run]
}

/// Each as it is measured.
pub(crate) fn whole(metadata: &Metadata) -> Vec<TestRun> {
    let mut run = TestRun {
        profile: Profile::Release,
        harness: &["--bench"],
        ..all(metadata)
    };
    run.options.extend(owned(&["--no-fail-fast"]));
    vec![run]
}

fn all(metadata: &Metadata) -> TestRun {
    let packages = metadata.workspace_packages();
    let targets = packages.iter().flat_map(|package| &package.targets);
    let benches = targets.filter(|target| target.is_bench());
    // By name: all of them would be the libraries' tests as well.
    let named = benches.map(|bench| Targets::Bench(bench.name.clone()));
    selection().of(named.collect())
}
