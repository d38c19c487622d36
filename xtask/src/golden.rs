//! The fixed runs whose hashes are known, optimised, and for the very processor at hand: compilers then pick other
//! instructions. The tests of the workspace run the one without rapier as they are built.

use cargo_metadata::Metadata;

use crate::run::cargo;

pub(crate) fn run(metadata: &Metadata) -> Result<(), String> {
    let run = ["-p", "clamber_climber", "--test", "golden"];
    cargo(&[&["test", "--release"][..], &run].concat())?;
    // Apart, or each of the two would have the other's dependencies built anew.
    let folder = metadata.target_directory.join("native");
    let native = "build.rustflags=[\"-C\", \"target-cpu=native\"]";
    let native = [
        "test",
        "--release",
        "--target-dir",
        folder.as_str(),
        "--config",
        native,
    ];
    // rapier's instructions depend on the processor, unless it is told otherwise.
    let battle = [
        "-p",
        "clamber",
        "--features",
        "clamber/deterministic",
        "--test",
        "golden_battle",
    ];
    cargo(&[&native[..], &run, &battle].concat())
}
