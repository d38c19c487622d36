//! The steps of `cargo xtask nightly`, which take too long for CI: every case of tests that have short forms, each
//! heavy feature alone, other engines, golden runs in other builds, packages that build alone, comparisons with other
//! libraries, the app on all of Bevy, every bench in full, and the soak.

use crate::build::owned;
use crate::run::IGNORE_RUST_VERSION;
use crate::steps::Step;
use crate::test_run::{Ignored, Packages, Profile, Targets, TestRun};
use crate::{app, battle, benches, ci, features, golden, packages, peers, soak};

/// The steps in the order in which they run.
pub(crate) const STEPS: [Step; 9] = [
    Step::runs("all cases", |_| vec![all_cases()]),
    Step {
        name: "features",
        runs: |metadata| features::runs(metadata, &ci::tests(metadata)),
        rest: features::check_heavy,
    },
    Step::runs("engines", |_| vec![engines()]),
    Step {
        name: "golden",
        runs: golden::other_builds,
        rest: battle::exchange_recordings,
    },
    Step::other("packages", packages::build),
    Step {
        name: "peers",
        runs: |_| peers::runs(),
        rest: peers::rest,
    },
    Step {
        name: "app",
        runs: |_| app::runs(),
        rest: |_| app::format(),
    },
    Step::runs("benches", benches::whole),
    Step::runs("soak", |_| vec![soak::nightly()]),
];

/// Runs the plugins in apps with avian and `bevy_rapier3d`: climbers on their terrain, bodies on skin, and all other
/// tests of the plugin. These two engines take minutes to build.
fn engines() -> TestRun {
    TestRun {
        packages: Packages::Named(owned(&["bevy_clamber"])),
        features: owned(&["bevy_clamber/avian", "bevy_clamber/rapier"]),
        targets: vec![
            Targets::Test("plugin".into()),
            Targets::Test("readme".into()),
        ],
        options: owned(&[IGNORE_RUST_VERSION]),
        ..TestRun::default()
    }
}

/// Packages with tests that other steps ignore, or run with a fifth of their cases.
const LONG: [&str; 6] = [
    "clamber",
    "clamber_climber",
    "clamber_colossus",
    "clamber_fight",
    "clamber_surface",
    "clamber_verify",
];

/// Runs the tests that other steps ignore, and all cases of tests that otherwise run a fifth of them. One test runs at
/// a time: some take gigabytes, and some measure time.
fn all_cases() -> TestRun {
    TestRun {
        profile: Profile::Release,
        packages: Packages::Named(owned(&LONG)),
        features: owned(&["clamber_surface/scalar"]),
        targets: vec![Targets::Library, Targets::Tests],
        ignored: Ignored::Included,
        options: owned(&["--no-fail-fast"]),
        harness: &["--test-threads", "1"],
        variables: &[("CLAMBER_ALL_CASES", "1")],
        ..TestRun::default()
    }
}
