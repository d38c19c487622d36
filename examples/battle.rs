//! The main job: a climber rides a walking, shaking creature for a minute.
//!
//! `cargo run --release --example battle -- --help` lists the options. The scene itself, its script
//! and its checks are `clamber_scenes::battle`.

use std::process::ExitCode;

use clamber_scenes::battle::{self, BattleOptions};

fn main() -> ExitCode {
    let options = BattleOptions::from_command_line();
    let summary = match battle::run(&options) {
        Ok(summary) => summary,
        Err(error) => {
            eprintln!("battle: {error}");
            return ExitCode::from(2);
        }
    };
    print!("{summary}");
    println!("  written to {}", options.out.display());
    if summary.holds() {
        ExitCode::SUCCESS
    } else {
        eprintln!("battle: a check failed");
        ExitCode::FAILURE
    }
}
