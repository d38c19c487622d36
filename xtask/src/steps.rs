//! Runs the steps of a task one after the other, and times them. After a failure the next step runs all the same, and
//! the summary lists failures and skipped tests.

use std::io::Write;
use std::sync::PoisonError;
use std::time::Instant;

use cargo_metadata::Metadata;

use crate::plan::steps;
use crate::process::{self, SKIPPED, cargo};

/// File of the table with the results of nightly steps, in cargo's target folder.
const RESULTS: &str = "nightly.md";

/// Beginning of the table; its columns are those in `docs/measured.md`.
const HEAD: &str = "| step | commit | seconds | result |\n|---|---|---|---|\n";

/// Work of a step.
pub(crate) type Check = fn(&Metadata) -> Result<(), String>;

/// A part of a task, which `--only` selects by its name.
pub(crate) struct Step {
    /// The task and the name, as in `ci: tests`.
    pub(crate) name: &'static str,
    /// Calls of cargo, after the environment variables that they set.
    pub(crate) runs: Vec<String>,
    /// Performed after the runs.
    pub(crate) checks: Vec<Check>,
}

impl Step {
    /// Performs all runs and checks; a failure does not stop it. Adds a line to the table of nightly results.
    fn perform(&self, metadata: &Metadata) -> Result<(), String> {
        let start = Instant::now();
        let runs = self.runs.iter().map(|line| cargo(line));
        let all = runs.chain(self.checks.iter().map(|check| check(metadata)));
        let mut failures: Vec<String> = all.filter_map(Result::err).collect();
        if let Some(name) = self.name.strip_prefix("nightly: ") {
            let seconds = start.elapsed().as_secs_f64();
            failures.extend(record(metadata, name, seconds, failures.is_empty()).err());
        }
        failures.is_empty().then_some(()).ok_or(failures.join("; "))
    }
}

/// Runs the steps of a task whose names contain `only`, which may be empty. Prints times, failures and skipped tests.
pub(crate) fn run(metadata: &Metadata, task: &str, only: &str) -> Result<(), String> {
    let mut steps = steps(metadata)?;
    steps.retain(|step| step.name.starts_with(task));
    let (mut times, mut failed, mut total) = (String::new(), Vec::new(), 0.0);
    for step in &steps {
        let name = step.name.trim_start_matches(task).trim_start_matches(": ");
        if !name.contains(only) {
            continue;
        }
        println!("== {name}");
        let start = Instant::now();
        if let Err(reason) = step.perform(metadata) {
            eprintln!("{name} FAILED: {reason}");
            failed.push(name);
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("   {name}: {seconds:.0} s");
        times += &format!("   {seconds:6.0} s  {name}\n");
        total += seconds;
    }
    if times.is_empty() {
        let names: Vec<&str> = steps.iter().map(|step| step.name).collect();
        return Err(format!(
            "no step has such a name; there are {}",
            names.join(", ")
        ));
    }
    print!("== summary\n{times}");
    let skipped = SKIPPED.lock().unwrap_or_else(PoisonError::into_inner);
    skipped.iter().for_each(|line| println!("   {line}"));
    let (ran, of, skipped) = (times.lines().count(), steps.len(), skipped.len());
    let ran = format!("{ran} of {of} steps ran in {total:.0} s, {skipped} SKIPPED tests");
    if failed.is_empty() {
        println!("{ran}, all passed");
        return Ok(());
    }
    Err(format!("{ran}, failed: {}", failed.join(", ")))
}

/// Adds a line to the table of nightly results. Runs of single steps on one commit add up to a whole run.
fn record(metadata: &Metadata, name: &str, seconds: f64, passed: bool) -> Result<(), String> {
    let path = metadata.target_directory.join(RESULTS);
    let head = if path.exists() { "" } else { HEAD };
    let (commit, result) = (commit(), if passed { "passed" } else { "failed" });
    let row = format!("{head}| {name} | {commit} | {seconds:.0} | {result} |\n");
    let file = std::fs::OpenOptions::new()
        .append(true)
        .create(true)
        .open(&path);
    let written = file.and_then(|mut file| file.write_all(row.as_bytes()));
    written.map_err(|error| format!("{path}: {error}"))
}

/// The current commit, and whether files differ from it.
fn commit() -> String {
    // Without tags, `describe` gives the hash alone.
    let line = "describe --always --exclude=* --abbrev=12 --dirty";
    let found = process::run("git", line);
    found.map_or("unknown".into(), |commit| {
        commit.trim().replace("-dirty", ", changed")
    })
}
