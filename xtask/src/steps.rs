//! Steps, one after the other, and others beside them: each is timed, a failure does not keep the next from running,
//! and the end lists failures and skipped tests.

use std::fs::File;
use std::process::{Child, Command, ExitCode};
use std::time::Instant;

use cargo_metadata::Metadata;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::run;

/// Its name and what it does.
pub(crate) type Step = (&'static str, fn(&Metadata) -> Result<(), String>);

/// Runs a task of this program beside `work`, in a process and a target folder of its own, since cargo lets no two
/// builds into one folder. Prints what the task has printed when both have ended.
pub(crate) fn beside(
    task: &[&str],
    metadata: &Metadata,
    work: impl FnOnce() -> ExitCode,
) -> ExitCode {
    let start = Instant::now();
    let folder = metadata.target_directory.join("checks");
    let started = start_beside(task, &folder);
    let (log, mut other) = match started {
        Ok(started) => started,
        Err(error) => {
            eprintln!("cannot start {}: {error}", task.join(" "));
            return ExitCode::FAILURE;
        }
    };
    let ended = work();
    let other = other.wait();
    println!("== beside: {}", task.join(" "));
    match std::fs::read(&log) {
        Ok(printed) => println!("{}", String::from_utf8_lossy(&printed)),
        Err(error) => eprintln!("{log}: {error}"),
    }
    println!("all in {:.0} s", start.elapsed().as_secs_f64());
    match other {
        Ok(status) if status.success() => ended,
        _ => {
            eprintln!("{} failed, see above", task.join(" "));
            ExitCode::FAILURE
        }
    }
}

/// Starts a task of this program that prints to a file.
fn start_beside(task: &[&str], folder: &Utf8Path) -> std::io::Result<(Utf8PathBuf, Child)> {
    std::fs::create_dir_all(folder)?;
    let log = folder.join("printed.txt");
    let file = File::create(&log)?;
    let child = Command::new(std::env::current_exe()?)
        .args(task)
        .env("CARGO_TARGET_DIR", folder)
        .stdout(file.try_clone()?)
        .stderr(file)
        .spawn()?;
    Ok((log, child))
}

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
