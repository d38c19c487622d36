//! `cargo xtask ci` runs what CI runs, for a person as well: tests, golden runs, format, lints, each feature,
//! documentation, public items, examples, benches, dependency arrows and their picture, packages; and checks that
//! nothing is left out of this, and no command of the documentation. `cargo xtask nightly` runs what takes hours.

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
    /// Everything that CI checks; goes on after a failure and lists them all at the end. Takes half an hour on a cold
    /// target.
    Ci {
        /// Run only the steps whose name contains this.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
    },
    /// What takes too long for CI: every case of tests that have short forms, golden runs in other builds, other
    /// libraries, the app on all of Bevy, a soak of half an hour. Takes some two hours on a cold target. Adds a line
    /// for each step to nightly.md in the target folder.
    Nightly {
        /// Run only the steps whose name contains this.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
    },
    /// Stores the public items of each crate, with which `ci` compares those that it finds.
    Face,
    /// Writes docs/commands.md, which says of every command in the documentation who runs it. `ci` compares it with the
    /// one that it would write.
    Commands,
    /// Draws the picture of the crates, docs/crates.svg, with which `ci` compares the one that it draws.
    Crates,
    /// The app on all of Bevy, which stands outside the workspace: its format, and a picture that it draws and
    /// checks by itself, off-screen. A job of its own: a cold build of Bevy takes many minutes.
    App,
    /// Stress cases of every family, every fuzz target on random bytes and whole battles, in release, with fresh seeds
    /// until the time is up. Checks that nothing panics, all numbers are finite, answers are those of brute force,
    /// bounds hold, closed skin lets no ray through, no contact is missed or late, and that of queries with like work
    /// the slowest thousandth takes at most 20 medians. Ends with a report, also in target/soak/report.md, which says
    /// how to repeat each finding, and fails if there is one.
    Soak {
        /// How long.
        #[arg(long, value_name = "MINUTES", default_value_t = 10.0)]
        minutes: f64,
        /// Of everything random: the same one gives the same tasks in the same order.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Runs this alone, as a report names it.
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
