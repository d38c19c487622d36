//! An hour of the giant's life in fast forward: reports the states of its brain, and checks that its feet stood on the
//! ground.
//!
//! `cargo run --release --example life -- --help` lists the options. The life itself is `clamber_scenes::life`.

use std::process::ExitCode;

use clamber_scenes::life::{LifeOptions, live};

fn main() -> ExitCode {
    let options = LifeOptions::from_command_line();
    let tally = match live(&options) {
        Ok(tally) => tally,
        Err(error) => {
            eprintln!("life: {error}");
            return ExitCode::from(2);
        }
    };
    println!("{tally}");
    let faults = tally.faults();
    for fault in &faults {
        eprintln!("life: {fault}");
    }
    if faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
