//! The fixed runs whose hashes are known, in other builds than that of the tests: compilers then pick other
//! instructions.

use cargo_metadata::Metadata;

use crate::build;
use crate::examples;
use crate::run::{cargo, cargo_with};

/// As released: the run of the core at all SIMD levels down to scalar code, and a battle.
pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    cargo(&[&["test"][..], &build::RELEASED, &["--test", "golden"]].concat())?;
    examples::compare_builds(metadata)
}

/// Bytes of a test's stack, an eighth of what Bevy's threads have: without optimisation functions need much.
const SMALL_STACK: &str = "262144";

/// As released, recorded and fought again by the other build; not optimised; and for the very processor at hand, with
/// rapier, whose instructions depend on the processor unless it is told otherwise.
pub(crate) fn other_builds(metadata: &Metadata) -> Result<(), String> {
    examples::exchange_recordings(metadata)?;
    let test = ["test", "-p", "clamber_climber", "--test", "golden"];
    let plain = "profile.dev.opt-level=0";
    // Apart, or each of these builds would have the other's dependencies built anew.
    let folder = metadata.target_directory.join("plain");
    cargo_with(
        &[
            &test[..],
            &["--config", plain, "--target-dir", folder.as_str()],
        ]
        .concat(),
        &[("RUST_MIN_STACK", SMALL_STACK)],
    )?;
    let folder = metadata.target_directory.join("native");
    let native = "build.rustflags=[\"-C\", \"target-cpu=native\"]";
    let battle = ["-p", "clamber", "--features", "clamber/deterministic"];
    let native = ["--release", "--config", native];
    let folder = ["--target-dir", folder.as_str(), "--test", "golden_battle"];
    cargo(&[&test[..], &native, &battle, &folder].concat())
}
