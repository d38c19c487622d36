//! Runs the golden tests, whose hashes are stored, in other builds than the tests' own: compilers then choose other
//! instructions.

use cargo_metadata::Metadata;

use crate::battle;
use crate::build::{owned, released};
use crate::run::cargo;
use crate::test_run::{self, Packages, Profile, Targets, TestRun};

/// Stack of a test's thread, bytes: an eighth of the stack of Bevy's threads. Functions need more stack without
/// optimisation, so overflows show here.
const SMALL_STACK: &str = "262144";

fn test(name: &str) -> Targets {
    Targets::Test(name.into())
}

/// Runs in the release profile: the core's run at all SIMD levels down to scalar code, and the battles with rapier.
pub(crate) fn runs() -> Vec<TestRun> {
    let mut run = released().of(vec![test("golden"), test("golden_battle")]);
    // Goes on after a failure: which of the tests fail tells where to look.
    run.options.push("--no-fail-fast".into());
    vec![run]
}

/// Compares a battle in the release profile and as built for tests.
pub(crate) fn rest(_: &Metadata) -> Result<(), String> {
    battle::compare_builds()
}

/// Runs without optimisation; and runs for the processor of this machine, with rapier, whose instructions then depend
/// on the processor.
pub(crate) fn other_builds(metadata: &Metadata) -> Vec<TestRun> {
    // A target folder for each build: in a shared one, each build would build the other's dependencies again.
    let apart = |folder: &str, config: &str| {
        let folder = metadata.target_directory.join(folder);
        owned(&["--config", config, "--target-dir", folder.as_str()])
    };
    let plain = TestRun {
        packages: Packages::Named(owned(&["clamber_climber"])),
        targets: vec![test("golden")],
        options: apart("plain", "profile.dev.opt-level=0"),
        variables: &[("RUST_MIN_STACK", SMALL_STACK)],
        perform: |metadata, run| {
            // Builds first without the variable: rustc would use the small stack as well, and overflow it.
            cargo(&[run.arguments("test", &[]), owned(&["--no-run"])].concat())?;
            test_run::test(metadata, run)
        },
        ..TestRun::default()
    };
    let native = TestRun {
        profile: Profile::Release,
        packages: Packages::Named(owned(&["clamber", "clamber_climber"])),
        features: owned(&["clamber/deterministic"]),
        targets: vec![test("golden"), test("golden_battle")],
        options: apart("native", "build.rustflags=[\"-C\", \"target-cpu=native\"]"),
        ..TestRun::default()
    };
    vec![plain, native]
}
