//! Checks that a step of `cargo xtask ci` or of `cargo xtask nightly` runs each test, bench, example and program in the
//! documentation, with the features that it requires, and each test that is marked as ignored. Cargo's metadata lists
//! the targets of all workspaces in the repository, cargo tells what the calls of the steps run, and the sources mark
//! ignored tests.
//!
//! A program in the documentation that is marked `no_run` is compiled with the others. A program that is marked
//! `ignore`, or `rs` instead of `rust`, is not even compiled, so a test must have the same program.

use cargo_metadata::camino::Utf8Path;
use cargo_metadata::{Metadata, Package};

use crate::call::{Part, parts};
use crate::plan::Plan;
use crate::workspace::{files, folder, no_faults, read};

/// Pages with programs that are not compiled. The test `readme` of `bevy_clamber` compiles the same programs.
const COMPILED: &str = "README.md crates/bevy_clamber/README.md docs/recipes/falling_crates.md";

/// The file whose modules are the pages of `docs/recipes` with programs.
const RECIPES: &str = "tests/scenes/src/recipes.rs";

/// Fails if there are gaps.
pub(crate) fn check(main: &Metadata) -> Result<(), String> {
    let plan = Plan::read(main)?;
    let recipes = read(&plan.root.join(RECIPES))?;
    let mut found = gaps(&plan);
    let compiles = Part::new("bevy_clamber", "test", "readme");
    if !plan.runs(&compiles) {
        found.push(format!("no step compiles the programs of {COMPILED}"));
    }
    for file in files(&plan.root)? {
        if matches!(file.extension(), Some("rs" | "md")) {
            let text = read(&plan.root.join(&file))?;
            found.extend(gaps_in(&plan, &file, &text));
            let page = file.strip_prefix("docs/recipes").ok();
            let is_module = |page: &str| recipes.split_whitespace().any(|word| word == page);
            if let Some(page) = page.and_then(Utf8Path::file_stem)
                && text.contains("```rust")
                && !is_module(page)
            {
                found.push(format!("{file}: {RECIPES} does not compile its programs"));
            }
        }
    }
    no_faults(&found, ": xtask/steps.txt has the steps")
}

/// The targets that no step runs, in sentences.
fn gaps(plan: &Plan) -> Vec<String> {
    let all = plan.packages.iter().flat_map(parts);
    let missing = all.filter(|(part, _)| !plan.runs(part));
    let gaps = missing.map(|(part, target)| {
        let needed = target.required_features.join(", ");
        format!("no step runs {part} with the features that it needs: [{needed}]")
    });
    gaps.collect()
}

/// The programs and tests in a file that no step runs, in sentences.
fn gaps_in(plan: &Plan, file: &Utf8Path, text: &str) -> Vec<String> {
    let path = plan.root.join(file);
    let mut above: Vec<&Package> = plan.packages.iter().collect();
    above.retain(|package| path.starts_with(folder(package)));
    let nearest = above
        .into_iter()
        .max_by_key(|package| folder(package).as_str().len());
    let owners = nearest.map_or(Vec::new(), |package| owners(package, &path));
    let is_run = |part: &Part| {
        let mut calls = plan.calls.iter().filter(|(_, call)| call.runs_ignored());
        calls.any(|(_, call)| call.parts.contains(part))
    };
    let not_run = owners.iter().find(|part| !is_run(part));
    let gap = |line: &str| {
        let code = line.trim_start();
        let comment = code.strip_prefix("///").or(code.strip_prefix("//!"));
        if let Some(language) = comment.unwrap_or(code).trim_start().strip_prefix("```") {
            let mut words = language.split(',').map(str::trim);
            let is_left_out = words.any(|word| word == "ignore" || word == "rs");
            let hint = "a program that is not even compiled: mark it `no_run`, or compare it in the test `readme` of \
                        bevy_clamber, and name the page in `COMPILED` in xtask/src/coverage.rs";
            let is_gap = is_left_out && !COMPILED.split(' ').any(|page| page == file);
            return is_gap.then(|| hint.to_owned());
        }
        if code.starts_with("#[test]") && owners.is_empty() {
            return Some("a test in a target without a harness, so cargo does not run it".into());
        }
        // As rustfmt leaves it: an attribute on further lines has each of its parts on a line.
        let mut marks = ["#[ignore]", "#[ignore =", "ignore = \""].iter();
        let is_conditional = code.starts_with("#[cfg_attr(") && code.contains(", ignore");
        let is_ignored = is_conditional || code == "ignore" || marks.any(|it| code.starts_with(it));
        let part = not_run.filter(|_| is_ignored)?;
        Some(format!(
            "an ignored test in {part}, whose ignored tests no step runs"
        ))
    };
    let lines = text.lines().enumerate();
    let gaps = lines.filter_map(|(at, line)| Some(format!("{file}:{}: {}", at + 1, gap(line)?)));
    gaps.collect()
}

/// The parts with a test harness that a source file may belong to. A target's own file belongs to that target alone.
/// Any other file belongs to the targets in the nearest folder above it. If there are several, each of them may have
/// the file as a module, so all are returned.
fn owners(package: &Package, file: &Utf8Path) -> Vec<Part> {
    let nearness = |source: &Utf8Path| {
        let folder = source.parent().filter(|folder| file.starts_with(folder));
        (source == file, folder.map(|folder| folder.as_str().len()))
    };
    let targets = package.targets.iter();
    let nearest = targets.map(|target| nearness(&target.src_path)).max();
    let nearest = nearest.unwrap_or_default();
    let mut owners = parts(package);
    owners.retain(|(part, target)| {
        let has_tests = matches!(part.kind, "lib" | "bin" | "test");
        has_tests && target.test && nearness(&target.src_path) == nearest
    });
    owners.into_iter().map(|(part, _)| part).collect()
}

#[cfg(test)]
mod tests {
    use super::{Plan, gaps, gaps_in};
    use crate::workspace::main;

    #[test]
    fn a_target_that_no_step_runs_is_a_gap() {
        let mut plan = Plan::read(&main().unwrap()).unwrap();
        assert_eq!(gaps(&plan), [""; 0]);
        let mut packages = plan.packages.iter_mut();
        let world = packages.find(|package| package.name == "clamber_world");
        let targets = &mut world.unwrap().targets;
        targets.extend(targets.iter().find(|target| target.is_test()).cloned());
        targets.last_mut().unwrap().name = "nobody".into();
        let removed = "benches examples peers";
        let name = |step: &str| step.rsplit(' ').next().unwrap().to_owned();
        plan.calls
            .retain(|(step, _)| !removed.contains(&name(step)));
        let gaps = gaps(&plan).join("\n");
        for part in [
            "test nobody of clamber_world",
            "bench tick of clamber_benches",
            "example battle of clamber",
            "test native of clamber_peers",
        ] {
            assert!(gaps.contains(&format!("runs {part}")), "{part} in {gaps}");
        }
    }

    /// Files with a line and a part of the gap that it is. `@` stands for the beginning of an attribute, and `~` for a
    /// fence, so that this file has no gaps.
    const LINES: &str = "\
crates/clamber_gltf/src/load.rs <= @ignore] <= lib clamber_gltf
crates/clamber_gltf/src/load.rs <= @cfg_attr(debug, ignore)] <= lib clamber_gltf
crates/clamber_gltf/src/load.rs <=     ignore = \"slow\" <= lib clamber_gltf
crates/clamber_gltf/src/load.rs <= // @ignore] <=
tests/golden_battle/more.rs <= @ignore = \"slow\"] <= test golden_battle of clamber
tests/modes/dash.rs <= @ignore] <=
examples/duel/line.rs <= @test] <= without a harness
docs/recipes/fight.md <= ~rust, ignore <= COMPILED";

    #[test]
    fn a_test_or_program_that_no_step_runs_is_a_gap() {
        let plan = Plan::read(&main().unwrap()).unwrap();
        for line in LINES.replace('@', "#[").replace('~', "```").lines() {
            let words: Vec<&str> = line.split("<=").map(str::trim).collect();
            let gaps = gaps_in(&plan, words[0].into(), words[1]).join("\n");
            let is_due = gaps.contains(words[2]) && gaps.is_empty() == words[2].is_empty();
            assert!(is_due, "{line}: {gaps}");
        }
    }
}
