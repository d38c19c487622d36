//! What takes too long for CI: every case of tests that have short forms, each heavy feature alone, other engines,
//! golden runs in other builds, packages that build by themselves, other libraries held against ours, the app on all of
//! Bevy, and the soak.

use cargo_metadata::Metadata;

use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_with};
use crate::steps::Step;
use crate::{app, features, golden, packages, peers, soak};

/// Minutes of the soak.
const MINUTES: f64 = 30.0;

pub(crate) const STEPS: [Step; 8] = [
    ("all cases", all_cases),
    ("features", |metadata| {
        features::check_heavy(metadata)?;
        features::test(metadata)
    }),
    ("engines", |_| engines()),
    ("golden", golden::other_builds),
    ("packages", packages::build),
    ("peers", |_| peers::check()),
    ("app", |_| app::check()),
    ("soak", |_| soak::run(MINUTES, 1, None)),
];

/// The plugins in apps with avian and `bevy_rapier3d`: climbers on their terrain, bodies on skin, and all the rest. These
/// two take minutes to build.
fn engines() -> Result<(), String> {
    cargo(&[
        "test",
        "-p",
        "bevy_clamber",
        "--features",
        "avian,rapier",
        IGNORE_RUST_VERSION,
        "--test",
        "plugin",
    ])
}

/// The tests that are ignored elsewhere, and all cases of those that run a fifth of them. One at a time: some take
/// gigabytes, some measure.
fn all_cases(_: &Metadata) -> Result<(), String> {
    let test = ["test", "--release", "--no-fail-fast"];
    let packages = [
        "-p",
        "clamber",
        "-p",
        "clamber_climber",
        "-p",
        "clamber_fuzz",
        "-p",
        "clamber_surface",
    ];
    let features = ["--features", "clamber_surface/scalar"];
    let ignored = ["--", "--include-ignored", "--test-threads", "1"];
    cargo_with(
        &[
            &test[..],
            &packages,
            &features,
            &["--lib", "--tests"],
            &ignored,
        ]
        .concat(),
        &[("CLAMBER_ALL_CASES", "1")],
    )
}
