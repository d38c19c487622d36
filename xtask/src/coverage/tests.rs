//! Tests with gaps that are added to the real repository's data.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use cargo_metadata::Target;

use super::marks::Mark;
use super::{Place, Tree, workspaces};

static REAL: OnceLock<Tree> = OnceLock::new();

/// The gaps that a change adds to the existing ones. `cargo xtask ci` fails if there are existing ones.
fn gaps_after(change: impl FnOnce(&mut Tree)) -> Vec<String> {
    let real = || Tree::read(&workspaces::main().unwrap()).unwrap();
    let mut tree = REAL.get_or_init(real).clone();
    let before = tree.gaps();
    change(&mut tree);
    let after: BTreeSet<String> = tree.gaps();
    after.difference(&before).cloned().collect()
}

/// Asserts that there is exactly one gap, and that its sentence has these words.
fn assert_gap(gaps: &[String], words: &[&str]) {
    assert_eq!(gaps.len(), 1, "{gaps:#?}");
    for word in words {
        assert!(gaps[0].contains(word), "{word:?} in {:?}", gaps[0]);
    }
}

/// Adds a copy of a package's first test target, renamed to `nobody`.
fn add_test(tree: &mut Tree, package: &str, change: impl FnOnce(&mut Target)) {
    let packages = tree.workspaces[0].metadata.packages.iter_mut();
    let mut packages = packages.filter(|known| known.name == package);
    let package = packages.next().unwrap();
    let mut tests = package.targets.iter().filter(|target| target.is_test());
    let mut target = tests.next().unwrap().clone();
    target.name = "nobody".into();
    change(&mut target);
    package.targets.push(target);
}

fn require(feature: &str) -> impl FnOnce(&mut Target) {
    move |target| target.required_features = vec![feature.into()]
}

fn add_mark(tree: &mut Tree, file: &str, mark: Mark) {
    let file = file.into();
    tree.places.push(Place {
        file,
        line: 7,
        mark,
    });
}

#[test]
fn tells_of_a_test_that_nothing_runs() {
    let gaps = gaps_after(|tree| add_test(tree, "clamber_world", |target| target.test = false));
    assert_gap(
        &gaps,
        &["the test `nobody` of clamber_world", "xtask/src/ci.rs"],
    );
}

#[test]
fn tells_of_features_that_nothing_turns_on() {
    // The feature is on in the libraries that Bevy's tests are built with, but not in the climber's own tests.
    let gaps = gaps_after(|tree| add_test(tree, "clamber_climber", require("bevy_reflect")));
    let words = [
        "the test `nobody` of clamber_climber",
        "bevy_reflect",
        "xtask/src/build.rs",
    ];
    assert_gap(&gaps, &words);
}

#[test]
fn a_required_feature_that_is_on_is_no_gap() {
    let gaps = gaps_after(|tree| add_test(tree, "clamber_climber", require("serde")));
    assert_eq!(gaps, [""; 0]);
}

#[test]
fn tells_of_a_battle_that_no_step_runs_with_its_features() {
    let gaps = gaps_after(|tree| tree.plan.retain(|planned| planned.step != "golden"));
    assert_gap(
        &gaps,
        &[
            "the test `golden_battle` of clamber",
            "deterministic, gltf, rapier",
        ],
    );
}

#[test]
fn tells_of_all_that_a_step_no_longer_runs() {
    let gaps = gaps_after(|tree| tree.plan.retain(|planned| planned.step != "benches"));
    let has = |words: &str| gaps.iter().any(|gap| gap.contains(words));
    assert!(has("the bench `tick` of clamber_benches"), "{gaps:#?}");
    assert!(
        gaps.iter().all(|gap| gap.contains("the bench")),
        "{gaps:#?}"
    );
}

#[test]
fn tells_of_documentation() {
    let gaps = gaps_after(|tree| tree.plan.retain(|planned| planned.step != "tests"));
    let has = |words: &str| gaps.iter().any(|gap| gap.contains(words));
    assert!(
        has("the documentation's tests of clamber_scenes"),
        "{gaps:#?}"
    );
}

#[test]
fn tells_of_a_workspace_that_nothing_runs() {
    let gaps = gaps_after(|tree| tree.plan.retain(|planned| planned.step != "peers"));
    let has = |words: &str| gaps.iter().any(|gap| gap.contains(words));
    assert!(
        has("the test `native` of clamber_peers (peers/Cargo.toml)"),
        "{gaps:#?}"
    );
}

#[test]
fn tells_of_ignored_tests_that_nothing_runs() {
    let file = "crates/clamber_gltf/src/load.rs";
    let gaps = gaps_after(|tree| add_mark(tree, file, Mark::Ignored));
    let words = [
        file,
        ":7:",
        "unit tests of clamber_gltf",
        "xtask/src/nightly.rs",
    ];
    assert_gap(&gaps, &words);
}

#[test]
fn tells_of_a_package_whose_ignored_tests_are_no_longer_run() {
    let gaps = gaps_after(|tree| tree.plan.retain(|planned| planned.step != "all cases"));
    let has = |words: &str| gaps.iter().any(|gap| gap.contains(words));
    assert!(has("tests/giant_bounds.rs"), "{gaps:#?}");
    assert!(has("the test `stress` of clamber_verify"), "{gaps:#?}");
}

#[test]
fn a_file_has_the_tests_of_the_target_in_whose_folder_it_is() {
    // Nightly runs the ignored tests of the package `clamber`, except those that require `deterministic`.
    let gaps = gaps_after(|tree| add_mark(tree, "tests/modes/dash.rs", Mark::Ignored));
    assert_eq!(gaps, [""; 0]);
    let gaps = gaps_after(|tree| add_mark(tree, "tests/golden_battle/more.rs", Mark::Ignored));
    assert_gap(
        &gaps,
        &[
            "tests/golden_battle/more.rs:7",
            "the test `golden_battle` of clamber",
        ],
    );
}

#[test]
fn tells_of_tests_that_have_no_harness() {
    let gaps = gaps_after(|tree| add_mark(tree, "examples/duel/line.rs", Mark::Test));
    assert_gap(&gaps, &["examples/duel/line.rs", "without a harness"]);
}

#[test]
fn tells_of_programs_that_are_not_compiled() {
    let page = "docs/recipes/fight.md";
    let gaps = gaps_after(|tree| add_mark(tree, page, Mark::NotCompiled));
    assert_gap(&gaps, &[page, "COMPILED"]);
}
