//! Steps, one after the other: each is timed, a failure does not keep the next from running, and the end lists failures
//! and skipped tests.

use std::process::ExitCode;
use std::time::Instant;

use cargo_metadata::Metadata;

use crate::run;

/// Its name and what it does.
pub(crate) type Step = (&'static str, fn(&Metadata) -> Result<(), String>);

/// Runs the steps whose names contain `only`, or all of them.
pub(crate) fn run(steps: &[Step], metadata: &Metadata, only: Option<&str>) -> ExitCode {
    let asked = |name: &str| only.is_none_or(|only| name.contains(only));
    let (mut failures, mut times) = (Vec::new(), Vec::new());
    for (name, step) in steps.iter().filter(|(name, _)| asked(name)) {
        println!("== {name}");
        let start = Instant::now();
        if let Err(reason) = step(metadata) {
            eprintln!("{name} FAILED: {reason}");
            failures.push(*name);
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("   {name}: {seconds:.0} s");
        times.push((*name, seconds));
    }
    if times.is_empty() {
        let names: Vec<&str> = steps.iter().map(|(name, _)| *name).collect();
        eprintln!("no step has such a name; there are {}", names.join(", "));
        return ExitCode::FAILURE;
    }
    println!("== summary");
    for (name, seconds) in &times {
        println!("   {seconds:6.0} s  {name}");
    }
    let skipped = run::skipped();
    for line in &skipped {
        println!("   {line}");
    }
    let total: f64 = times.iter().map(|(_, seconds)| seconds).sum();
    let ran = format!(
        "{} of {} steps ran in {total:.0} s",
        times.len(),
        steps.len()
    );
    let skipped = match skipped.len() {
        0 => "nothing skipped".to_owned(),
        count => format!("{count} SKIPPED, see above"),
    };
    if failures.is_empty() {
        println!("{ran}, all passed, {skipped}");
        ExitCode::SUCCESS
    } else {
        eprintln!("{ran}, failed: {}, {skipped}", failures.join(", "));
        ExitCode::FAILURE
    }
}
