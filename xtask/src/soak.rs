//! Runs the example `soak` of `clamber_verify` in the release profile.

use crate::build::owned;
use crate::run::cargo;
use crate::test_run::{Packages, Profile, Targets, TestRun};

/// Duration of the nightly soak, minutes.
const MINUTES: f64 = 30.0;

/// Options that the soak gets.
const GIVEN: [&str; 2] = ["--minutes", "--seed"];

/// The soak of the nightly task.
pub(crate) fn nightly() -> TestRun {
    TestRun {
        profile: Profile::Release,
        packages: Packages::Named(owned(&["clamber_verify"])),
        features: owned(&["clamber_surface/scalar"]),
        targets: vec![Targets::Example("soak".into())],
        given: |_| GIVEN.to_vec(),
        perform: |_, run| soak(run, MINUTES, 1, None),
        ..TestRun::default()
    }
}

/// Builds and runs the soak; an error if it finds a fault.
pub(crate) fn run(minutes: f64, seed: u64, case: Option<&str>) -> Result<(), String> {
    soak(&nightly(), minutes, seed, case)
}

fn soak(run: &TestRun, minutes: f64, seed: u64, case: Option<&str>) -> Result<(), String> {
    let (minutes, seed) = (minutes.to_string(), seed.to_string());
    let mut options = vec![GIVEN[0], &minutes, GIVEN[1], &seed];
    options.extend(case.iter().flat_map(|case| ["--case", case]));
    cargo(&run.arguments("run", &options))
}
