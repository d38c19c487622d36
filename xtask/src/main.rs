//! `cargo xtask ci` runs what CI runs, for a person as well: tests, golden runs, format, lints, each feature,
//! documentation, public items, examples, benches, dependency arrows and their picture, packages. `cargo xtask nightly`
//! runs what takes hours.

mod app;
mod arrows;
mod benches;
mod build;
mod crates;
mod examples;
mod face;
mod features;
mod golden;
mod modules;
mod nightly;
mod packages;
mod peers;
mod run;
mod soak;
mod steps;

use std::process::ExitCode;

use cargo_metadata::MetadataCommand;
use clap::{Parser, Subcommand};
use run::{IGNORE_RUST_VERSION, cargo};
use steps::Step;

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
    /// libraries, the app on all of Bevy, a soak of half an hour. Takes some two hours on a cold target.
    Nightly {
        /// Run only the steps whose name contains this.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
    },
    /// Stores the public items of each crate, with which `ci` compares those that it finds.
    Face,
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

const STEPS: [Step; 12] = [
    ("tests", |_| {
        // The command of the front page; then all that it leaves out.
        cargo(&["test"])?;
        cargo(&[&["test"][..], &build::beyond_default()].concat())
    }),
    ("golden", golden::run),
    ("examples", examples::run),
    ("benches", benches::run),
    ("format", |_| cargo(&["fmt", "--all", "--check"])),
    ("arrows", |metadata| {
        arrows::check(metadata)?;
        modules::check()
    }),
    ("crates", crates::check),
    ("packages", packages::check),
    ("lints", |_| {
        let lint = ["clippy", "--all-targets", "--quiet", "--workspace"];
        let all = ["--all-features", IGNORE_RUST_VERSION];
        cargo(&[&lint[..], &all, &["--", "-D", "warnings"]].concat())
    }),
    ("documentation", |_| {
        let doc = [
            "doc",
            "--workspace",
            "--no-deps",
            "--all-features",
            IGNORE_RUST_VERSION,
            "--quiet",
        ];
        run::cargo_with(&doc, &[("RUSTDOCFLAGS", "-D warnings")])
    }),
    ("face", face::check),
    ("features", features::check),
];

fn main() -> ExitCode {
    if let Some(ended) = face::as_rustdoc() {
        return ended;
    }
    let task = Arguments::parse().task;
    let metadata = match MetadataCommand::new().exec() {
        Ok(metadata) => metadata,
        Err(error) => {
            eprintln!("cargo metadata failed: {error}");
            return ExitCode::FAILURE;
        }
    };
    // Wherever it was called from.
    let root = &metadata.workspace_root;
    if let Err(error) = std::env::set_current_dir(root) {
        eprintln!("{root}: {error}");
        return ExitCode::FAILURE;
    }
    match task {
        Task::Ci { only } => steps::run(&STEPS, &metadata, only.as_deref()),
        Task::Nightly { only } => steps::run(&nightly::STEPS, &metadata, only.as_deref()),
        Task::App => ended(app::check()),
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
