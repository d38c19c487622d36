//! The fixed runs whose hashes are known, in other builds than that of the tests: compilers then pick other
//! instructions.

use cargo_metadata::Metadata;

use crate::battle;
use crate::build::{owned, released};
use crate::run::cargo;
use crate::test_run::{self, Packages, Profile, Targets, TestRun};

/// Bytes of a test's stack, an eighth of what Bevy's threads have: without optimisation functions need much.
const SMALL_STACK: &str = "262144";

fn test(name: &str) -> Targets {
    Targets::Test(name.into())
}

/// As released: the run of the core at all SIMD levels down to scalar code, and the battles with rapier.
pub(crate) fn runs() -> Vec<TestRun> {
    let mut run = released().of(vec![test("golden"), test("golden_battle")]);
    // Which of them fail tells where to look.
    run.options.push("--no-fail-fast".into());
    vec![run]
}

/// A battle as released, and as built for tests.
pub(crate) fn rest(_: &Metadata) -> Result<(), String> {
    battle::compare_builds()
}

/// Not optimised; and for the very processor at hand, with rapier, whose instructions depend on the processor unless it
/// is told otherwise.
pub(crate) fn other_builds(metadata: &Metadata) -> Vec<TestRun> {
    // Apart, or each of these builds would have the other's dependencies built anew.
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
            // rustc would take the small stack for itself, and overflow it.
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
