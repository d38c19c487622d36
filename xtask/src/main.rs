//! `cargo xtask ci` runs all checks of CI, for developers as well: tests, golden runs, format, lints, each feature,
//! documentation, public items, examples, benches, dependency arrows and their picture, packages. It also checks that
//! its steps leave out no test and no command of the documentation. `cargo xtask nightly` runs the checks that take
//! hours.

mod app;
mod arrows;
mod battle;
mod benches;
mod build;
mod ci;
mod commands;
mod coverage;
mod crates;
mod examples;
mod face;
mod features;
mod files;
mod golden;
mod modules;
mod nightly;
mod packages;
mod parts;
mod peers;
mod plan;
mod results;
mod run;
mod soak;
mod steps;
mod targets;
mod test_run;
mod turned_on;
mod workspaces;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Tasks of this workspace.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Runs all checks of CI. Goes on after a failure and lists all failures at the end. Takes half an hour on a cold
    /// target.
    Ci {
        /// Run only the steps whose name contains this.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
    },
    /// Runs the checks that take too long for CI: every case of tests that have short forms, golden runs in other
    /// builds, other libraries, the app on all of Bevy, a soak of half an hour. Takes some two hours on a cold target.
    /// Adds a line for each step to nightly.md in the target folder.
    Nightly {
        /// Run only the steps whose name contains this.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
    },
    /// Stores the list of each crate's public items. `ci` compares the items that it finds with it.
    Face,
    /// Writes docs/commands.md, the list of all commands in the documentation with the step that runs each. `ci`
    /// compares it with the list that it would write.
    Commands,
    /// Draws docs/crates.svg, the picture of the crates. `ci` compares it with the picture that it would draw.
    Crates,
    /// Checks the app on all of Bevy, which has a workspace of its own: its format, its tests, and a picture that it
    /// draws off-screen. CI has a job of its own for it: a cold build of Bevy takes many minutes.
    App,
    /// Runs stress cases of every family, every fuzz target on random bytes and whole battles, in release, with fresh
    /// seeds until the time is up. Checks that nothing panics, all numbers are finite, answers equal brute force,
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

fn main() -> ExitCode {
    if let Some(ended) = face::as_rustdoc() {
        return ended;
    }
    let task = Arguments::parse().task;
    let metadata = match workspaces::main() {
        Ok(metadata) => metadata,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    let root = &metadata.workspace_root;
    if let Err(error) = std::env::set_current_dir(root) {
        eprintln!("{root}: {error}");
        return ExitCode::FAILURE;
    }
    match task {
        Task::Ci { only } => steps::run(&ci::STEPS, &metadata, only.as_deref(), |_, _| Ok(())),
        Task::Nightly { only } => {
            steps::run(&nightly::STEPS, &metadata, only.as_deref(), results::add)
        }
        Task::App => ended(app::check(&metadata)),
        Task::Commands => ended(commands::store(&metadata)),
        Task::Face => ended(face::store(&metadata)),
        Task::Crates => ended(crates::store(&metadata)),
        Task::Soak {
            minutes,
            seed,
            case,
        } => ended(soak::run(minutes, seed, case.as_deref())),
    }
}

/// The exit code of a task without steps.
fn ended(came: Result<(), String>) -> ExitCode {
    match came {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}
