//! Valid commands, and wrong ones that resemble them.

use std::sync::OnceLock;

use super::who::Who;
use crate::workspaces;

static WHO: OnceLock<Who> = OnceLock::new();

fn runs(command: &str) -> Result<Option<String>, String> {
    let who = WHO.get_or_init(|| Who::new(&workspaces::main().unwrap()).unwrap());
    who.runs(command, &["README.md".into()])
}

/// Asserts that this step runs a command.
fn assert_step(command: &str, step: &str) {
    assert_eq!(runs(command), Ok(Some(step.into())), "{command}");
}

/// Asserts that no step runs a valid command.
fn assert_nobody(command: &str) {
    assert_eq!(runs(command), Ok(None), "{command}");
}

/// Asserts that a command is refused with a reason that has these words.
fn assert_wrong(command: &str, words: &str) {
    let why = runs(command).unwrap_err();
    assert!(why.contains(words), "{command}: {why}");
}

#[test]
fn an_example_is_run_with_its_features_and_options() {
    assert_step("cargo run --release --example battle", "ci: examples");
    assert_step(
        "cargo run --release --features record --example replay -- FILE --from 9",
        "ci: examples",
    );
    assert_nobody("cargo run --release --example battle -- --rocks 3");
    assert_wrong(
        "cargo run --release --example battel",
        "no package has `--example battel`",
    );
    assert_wrong("cargo run --release --example replay", "needs features");
    assert_wrong(
        "cargo run --features recrod --example battle",
        "no feature `recrod`",
    );
    assert_wrong(
        "cargo run -p clamber_verif --example soak",
        "no package `clamber_verif`",
    );
}

#[test]
fn a_test_is_run_with_its_ignored_ones() {
    assert_step("cargo test", "ci: tests");
    assert_step("cargo test --test bots", "ci: tests");
    assert_step(
        "cargo test --features deterministic --test golden_battle",
        "ci: golden",
    );
    assert_step(
        "cargo test -p clamber_verify --test stress -- --include-ignored",
        "nightly: all cases",
    );
    assert_nobody("cargo test -p clamber_gltf --lib -- --ignored");
    assert_nobody("CLAMBER_BLESS=1 cargo test --test bots");
    assert_wrong("cargo test --test bot", "no package has `--test bot`");
    assert_wrong(
        "cargo test -p clamber_surface --lib -- time_of_eddies",
        "no test `time_of_eddies`",
    );
}

#[test]
fn a_bench_is_run_with_its_features() {
    assert_step("cargo bench -p clamber_benches --bench tick", "ci: benches");
    let peers = "cargo bench --manifest-path peers/Cargo.toml";
    assert_step(
        &format!("{peers} --bench peers -- queries"),
        "nightly: peers",
    );
    assert_nobody(&format!("{peers} --features physx --bench peers"));
    assert_wrong(
        &format!("{peers} --bench pears"),
        "no package has `--bench pears`",
    );
    assert_wrong(
        "cargo bench --manifest-path pears/Cargo.toml --bench peers",
        "no workspace at pears",
    );
}

#[test]
fn documentation_is_built() {
    assert_step("cargo doc --open -p clamber_record", "ci: documentation");
    assert_wrong("cargo doc -p clamber_recrod", "no package `clamber_recrod`");
}

#[test]
fn a_task_is_one_of_xtask() {
    assert_step("cargo xtask ci --only golden", "ci: golden");
    assert_step("cargo xtask soak --minutes 10", "nightly: soak");
    assert_step("cargo xtask face", "ci: face");
    assert_wrong(
        "cargo xtask ci --only gulden",
        "no step of ci is called gulden",
    );
    assert_wrong("cargo xtask sok", "sok");
    assert_wrong("cargo xtask soak --minute 10", "--minute");
}

#[test]
fn the_program_is_run_by_its_tests() {
    assert_step("clamber inspect --humanoid FILE", "ci: tests");
    assert_step("cargo run -p clamber_cli -- inspect FILE", "ci: tests");
    assert_nobody("clamber inspect --hominid FILE");
    assert_nobody("clamber inspct FILE");
}

#[test]
fn another_workspace_is_entered() {
    assert_step(
        "cd examples/bevy && cargo run --release -- --screenshot a.png",
        "nightly: app",
    );
    assert_nobody("cd examples/bevy && cargo run --features gamepad");
    assert_nobody("cargo run --release --example battle -- --out x | cat");
}

#[test]
fn paths_and_features_of_what_is_installed_exist() {
    assert_nobody("cargo add --path ../clamber --features serde,record");
    assert_wrong(
        "cargo add --path ../clamber --features serde,recrod",
        "no feature `recrod`",
    );
    assert_wrong(
        "cargo install --path crates/clamber_clj",
        "crates/clamber_clj",
    );
    assert_wrong(
        "blender -b -P assets/collosus.py",
        "there is no assets/collosus.py",
    );
}
