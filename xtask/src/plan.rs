//! Reads the steps of `cargo xtask ci` and `cargo xtask nightly` from `xtask/steps.txt`, and adds their checks.

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Metadata, Package};

use crate::call::{Call, Part, ask};
use crate::process::split;
use crate::steps::{Check, Step};
use crate::workspace::all;
use crate::{arrows, battle, commands, coverage, examples, face, features, modules, packages};

/// The calls of cargo of each step, and the words that stand for others.
const STEPS: &str = include_str!("../steps.txt");

/// The checks that steps perform after their calls.
const CHECKS: [(&str, Check); 13] = [
    ("ci: golden", battle::compare_builds),
    ("ci: examples", examples::run_all),
    ("ci: coverage", coverage::check),
    ("ci: commands", commands::check),
    ("ci: arrows", arrows::check),
    ("ci: arrows", modules::check),
    ("ci: crates", arrows::check_chart),
    ("ci: packages", packages::check),
    ("ci: face", face::check),
    ("ci: features", features::check),
    ("nightly: features", features::check_heavy),
    ("nightly: golden", battle::exchange_recordings),
    ("nightly: packages", packages::build),
];

/// The steps of both tasks.
pub(crate) fn steps(metadata: &Metadata) -> Result<Vec<Step>, String> {
    let mut steps: Vec<Step> = Vec::new();
    for line in STEPS.lines() {
        if let Some(line) = line.strip_prefix("    ") {
            let step = steps.last_mut().ok_or("a call before the first step")?;
            step.runs.push(expand(metadata, line));
        } else if line.starts_with("ci: ") || line.starts_with("nightly: ") {
            let (name, runs) = (line, Vec::new());
            let checks = CHECKS.iter().filter(|(step, _)| *step == name);
            let checks = checks.map(|(_, check)| *check).collect();
            steps.push(Step { name, runs, checks });
        }
    }
    let is_missing = |name: &&str| steps.iter().all(|step| step.name != *name);
    if let Some(name) = CHECKS.iter().map(|(name, _)| *name).find(is_missing) {
        return Err(format!(
            "{name} has a check, and is no step of xtask/steps.txt"
        ));
    }
    let more = features::runs(metadata, &steps[0].runs)?;
    let mut all = steps.iter_mut();
    let step = all.find(|step| step.name == "nightly: features");
    step.ok_or("no step for features")?.runs.extend(more);
    Ok(steps)
}

/// Replaces the words in braces.
pub(crate) fn expand(metadata: &Metadata, line: &str) -> String {
    let pieces = line.split(['{', '}']).enumerate();
    let expanded = pieces.map(|(index, piece)| match index % 2 {
        0 => piece.to_owned(),
        _ => expand(metadata, &words(metadata, piece)),
    });
    expanded.collect()
}

/// The words that stand for a name in braces.
fn words(metadata: &Metadata, name: &str) -> String {
    let mut words = String::new();
    match name {
        "target" => words += metadata.target_directory.as_str(),
        "benches" => {
            let packages = metadata.workspace_packages();
            let targets = packages.iter().flat_map(|package| &package.targets);
            // By name, because `--benches` would also run the libraries' tests.
            for target in targets.filter(|target| target.is_bench()) {
                words += &format!("--bench {} ", target.name);
            }
        }
        _ => {
            let mut defined = STEPS.lines().filter_map(|line| line.split_once(" = "));
            let defined = defined.find(|(known, _)| *known == name);
            // An option that cargo refuses, with the name in its error.
            words += &defined.map_or(format!("--undefined={name}"), |it| it.1.to_owned());
        }
    }
    words
}

/// The repository, as the checks of coverage and commands see it.
pub(crate) struct Plan {
    pub(crate) root: Utf8PathBuf,
    /// The packages of all workspaces.
    pub(crate) packages: Vec<Package>,
    /// The names of the steps with their calls, first those in CI.
    pub(crate) calls: Vec<(&'static str, Call)>,
    /// The names of all steps.
    pub(crate) steps: Vec<&'static str>,
}

impl Plan {
    /// True if a step runs a part.
    pub(crate) fn runs(&self, part: &Part) -> bool {
        self.calls.iter().any(|(_, call)| call.parts.contains(part))
    }

    /// Asks cargo about the calls of all steps.
    pub(crate) fn read(main: &Metadata) -> Result<Self, String> {
        let (root, workspaces, steps) = (main.workspace_root.clone(), all(main)?, steps(main)?);
        let mut calls = Vec::new();
        for step in &steps {
            // A call without `test`, `build` or `run` is a check of another kind.
            let runs = step.runs.iter().filter(|line| {
                let command = split(line).1.split(' ').next();
                matches!(command, Some("test" | "build" | "run")) && !line.contains("--no-run")
            });
            for line in runs {
                calls.push((step.name, ask(&root, line)?));
            }
        }
        let packages = workspaces
            .iter()
            .flat_map(|it| it.metadata.workspace_packages());
        let packages = packages.cloned().collect();
        let steps = steps.iter().map(|step| step.name).collect();
        Ok(Self {
            root,
            packages,
            calls,
            steps,
        })
    }
}
