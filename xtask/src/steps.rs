//! Runs steps one after the other. Each step is timed. After a failure the next step runs all the same, and the summary
//! lists failures and skipped tests.

use std::process::ExitCode;
use std::time::Instant;

use cargo_metadata::Metadata;

use crate::run;
use crate::test_run::TestRun;

/// The work of a step besides its runs.
type Rest = fn(&Metadata) -> Result<(), String>;

/// A part of a task, which `--only` selects by its name.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    /// The tests, benches and examples that the step runs, for the main workspace. No step may run them in another way,
    /// or the check of coverage would not see them.
    pub(crate) runs: fn(&Metadata) -> Vec<TestRun>,
    /// The work after the runs.
    pub(crate) rest: Rest,
}

impl Step {
    /// A step that only runs tests, benches or examples.
    pub(crate) const fn runs(name: &'static str, runs: fn(&Metadata) -> Vec<TestRun>) -> Self {
        Self {
            name,
            runs,
            rest: |_| Ok(()),
        }
    }

    /// A step without tests, benches and examples.
    pub(crate) const fn other(name: &'static str, rest: Rest) -> Self {
        Self {
            name,
            runs: |_| Vec::new(),
            rest,
        }
    }

    /// Performs all runs and the rest; a failure does not stop it.
    fn perform(&self, metadata: &Metadata) -> Result<(), String> {
        let runs = (self.runs)(metadata);
        let ran = runs.iter().map(|run| (run.perform)(metadata, run));
        let all = ran.chain(std::iter::once_with(|| (self.rest)(metadata)));
        let failures: Vec<String> = all.filter_map(Result::err).collect();
        if failures.is_empty() {
            Ok(())
        } else {
            Err(failures.join("; "))
        }
    }
}

/// The result of a step.
pub(crate) struct Ended {
    pub(crate) name: &'static str,
    pub(crate) seconds: f64,
    pub(crate) passed: bool,
}

/// Runs the steps whose names contain `only`, or all steps. Calls `tell` for each step that ends.
pub(crate) fn run(
    steps: &[Step],
    metadata: &Metadata,
    only: Option<&str>,
    tell: fn(&Metadata, &Ended) -> Result<(), String>,
) -> ExitCode {
    let asked = |name: &str| only.is_none_or(|only| name.contains(only));
    let mut all = Vec::new();
    for step in steps.iter().filter(|step| asked(step.name)) {
        let name = step.name;
        println!("== {name}");
        let start = Instant::now();
        let came = step.perform(metadata);
        let mut ended = Ended {
            name,
            seconds: start.elapsed().as_secs_f64(),
            passed: came.is_ok(),
        };
        if let Err(reason) = came.and(tell(metadata, &ended)) {
            eprintln!("{name} FAILED: {reason}");
            ended.passed = false;
        }
        println!("   {name}: {:.0} s", ended.seconds);
        all.push(ended);
    }
    if all.is_empty() {
        let names: Vec<&str> = steps.iter().map(|step| step.name).collect();
        eprintln!("no step has such a name; there are {}", names.join(", "));
        return ExitCode::FAILURE;
    }
    summary(&all, steps.len())
}

/// Prints times, failures and skipped tests.
fn summary(all: &[Ended], steps: usize) -> ExitCode {
    println!("== summary");
    for Ended { name, seconds, .. } in all {
        println!("   {seconds:6.0} s  {name}");
    }
    let skipped = run::skipped();
    for line in &skipped {
        println!("   {line}");
    }
    let total: f64 = all.iter().map(|ended| ended.seconds).sum();
    let ran = format!("{} of {steps} steps ran in {total:.0} s", all.len());
    let skipped = match skipped.len() {
        0 => "nothing skipped".to_owned(),
        count => format!("{count} SKIPPED, see above"),
    };
    let failed = all.iter().filter(|ended| !ended.passed);
    let failed: Vec<&str> = failed.map(|ended| ended.name).collect();
    if failed.is_empty() {
        println!("{ran}, all passed, {skipped}");
        ExitCode::SUCCESS
    } else {
        eprintln!("{ran}, failed: {}, {skipped}", failed.join(", "));
        ExitCode::FAILURE
    }
}
