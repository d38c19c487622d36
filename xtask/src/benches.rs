//! Runs all benches. CI runs each of them once, briefly, so that each runs and its checks hold. CI uses the profile of
//! tests, whose builds exist already: the release profile would build all of Bevy again. The nightly task runs the
//! benches in full in the release profile, where a bench fails if it misses a bound by far.

use cargo_metadata::Metadata;

use crate::build::{owned, selection};
use crate::test_run::{Profile, Targets, TestRun};

/// Runs each bench once, briefly.
pub(crate) fn runs(metadata: &Metadata) -> Vec<TestRun> {
    let mut run = TestRun {
        harness: &["--test"],
        ..all(metadata)
    };
    run.options.push("--quiet".into());
    vec![run]
}

/// Runs each bench in full, as for measurements.
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
    // Selects benches by name, because `--benches` would also run the libraries' tests.
    let named = benches.map(|bench| Targets::Bench(bench.name.clone()));
    selection().of(named.collect())
}
