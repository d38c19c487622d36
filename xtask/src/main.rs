//! `cargo xtask ci` runs all checks of CI, for developers as well: tests, golden runs, format, lints, each feature,
//! documentation, public items, examples, benches, dependency arrows and their picture, packages. It also checks that
//! its steps leave out no test and no command of the documentation. `cargo xtask nightly` runs the checks that take
//! hours.

mod arrows;
mod battle;
mod call;
mod commands;
mod coverage;
mod examples;
mod face;
mod features;
mod modules;
mod packages;
mod pages;
mod plan;
mod process;
mod steps;
mod workspace;

use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

/// Tasks of this workspace.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Runs all checks of CI. Goes on after a failure and lists all failures at the end. Takes 25 minutes on two
    /// cores once the dependencies are built.
    Ci(Only),
    /// Runs the checks that take too long for CI: every case of tests that have short forms, golden runs in other
    /// builds, other libraries, the app on all of Bevy, a soak of half an hour and an hour of the giant's life. Takes
    /// some three hours on a cold target. Adds a line for each step to nightly.md in the target folder.
    Nightly(Only),
    /// Stores the list of each crate's public items. `ci` compares the items that it finds with it.
    Face,
    /// Prints all commands in the documentation, with the step that runs each, or the reason why none does.
    Commands,
    /// Runs stress cases of every family, every fuzz target on random bytes, whole battles and arenas, in release, with
    /// fresh seeds until the time is up. Checks that nothing panics, all numbers are finite, answers equal brute force,
    /// bounds hold, closed skin lets no ray through, no contact is missed or late, and that among queries with similar
    /// work the slowest thousandth takes at most 20 medians. Ends with a report, also in target/soak/report.md, which
    /// says how to repeat each finding. Fails if there is a finding.
    Soak {
        /// Duration in minutes.
        #[arg(long, value_name = "MINUTES", default_value_t = 10.0)]
        minutes: f64,
        /// Seed of all random numbers. The same seed gives the same tasks in the same order.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Runs this task alone, by its name in a report.
        #[arg(long, value_name = "TASK")]
        case: Option<String>,
    },
}

#[derive(Args)]
struct Only {
    /// Run only the steps whose name contains this.
    #[arg(long, value_name = "NAME")]
    #[arg(default_value = "", hide_default_value = true)]
    only: String,
}

fn main() -> ExitCode {
    if let Some(ended) = face::as_rustdoc() {
        return ended;
    }
    match run(Arguments::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

/// Runs a task in the root of the repository.
fn run(task: Task) -> Result<(), String> {
    let metadata = workspace::main()?;
    let root = &metadata.workspace_root;
    std::env::set_current_dir(root).map_err(|error| format!("{root}: {error}"))?;
    match task {
        Task::Ci(Only { only }) => steps::run(&metadata, "ci", &only),
        Task::Nightly(Only { only }) => steps::run(&metadata, "nightly", &only),
        Task::Face => face::store(&metadata),
        Task::Commands => commands::print(&metadata),
        Task::Soak {
            minutes,
            seed,
            case,
        } => {
            let case = case.map_or(String::new(), |case| format!("--case {case}"));
            let line = plan::expand(&metadata, "run {soak}");
            process::cargo(&format!("{line} --minutes {minutes} --seed {seed} {case}"))
        }
    }
}
