//! Runs stress cases of every family, every fuzz target on random bytes, whole battles and whole arenas with fresh
//! seeds, until the time is up. `cargo xtask soak` builds and runs it.

#![expect(clippy::panic, reason = "a finding is a panic, caught and reported")]

mod arena;
mod fight;
mod findings;
mod life;
mod plan;
mod report;
mod task;

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clamber_scenes::SceneError;
use clamber_scenes::battle::positive;
use clamber_scenes::giant::giant;
use clamber_scenes::measure::checked;
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use report::Report;
use task::Task;

/// Runs stress cases, fuzz targets, battles and arenas with fresh seeds until the time is up.
///
/// Prints a report and writes it to report.md. Exits with 1 if there is a finding, or if the slowest thousandth of a
/// class of queries takes more than 20 times the class's median, and with 2 after an error. The same seed gives the
/// same tasks in the same order.
#[derive(Debug, Parser)]
#[command(name = "soak", version)]
struct Options {
    /// Time to run; of the task `life`, the length of the life.
    #[arg(long, value_name = "MINUTES", default_value_t = 0.1)]
    #[arg(value_parser = positive, allow_negative_numbers = true)]
    minutes: f64,

    /// Seed for everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Run only this task, by its name in a report, and let it panic: stress/CASE, battle/SEED, arena/SEED,
    /// queries/SEED, palettes/SEED, builder/SEED or import/SEED; or life/SEED, which runs only so. The seed is 1 if it
    /// is left out.
    #[arg(long, value_name = "TASK")]
    case: Option<Task>,

    /// Folder for report.md and times.csv.
    #[arg(long, value_name = "DIR", default_value = "target/soak")]
    out: PathBuf,
}

fn main() -> ExitCode {
    checked("soak", run(&Options::parse()))
}

/// Runs the tasks; true if all checks hold.
fn run(options: &Options) -> Result<bool, SceneError> {
    let giant = giant()?;
    let mut report = Report::new(options.seed);
    if let Some(task) = options.case {
        let checks = task.run(&giant, options.minutes, &mut report.times);
        println!("{task}: {checks} checks, all hold");
        return Ok(true);
    }
    findings::keep_panics();
    let start = Instant::now();
    let length = Duration::from_secs_f64(options.minutes * 60.0);
    let bar = bar(length);
    for task in plan::tasks(options.seed) {
        let elapsed = start.elapsed();
        if elapsed >= length {
            break;
        }
        bar.set_position(elapsed.as_secs());
        bar.set_message(format!("{} findings  {task}", report.findings()));
        let came = findings::caught(|| task.run(&giant, options.minutes, &mut report.times));
        report.note(task, came);
    }
    bar.finish_and_clear();
    report.minutes = start.elapsed().as_secs_f64() / 60.0;
    println!("{report}");
    let written = report.write(&options.out);
    written.map_err(|error| format!("{}: {error}", options.out.display()))?;
    Ok(report.holds())
}

/// A bar with the elapsed and the total time, and the current task; hidden if standard error is not a terminal.
fn bar(length: Duration) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length.as_secs().max(1));
    let template = "{bar:30} {elapsed_precise} of {len} s  {wide_msg}";
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
