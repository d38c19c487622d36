//! Runs the battle's ride on many models, and reports which checks hold on creatures that were not made for this
//! project.
//!
//! `cargo run --release --example rides -- --help` lists the options. The rides themselves are
//! `clamber_scenes::battle::ride_all`.

use std::process::ExitCode;

use clamber_scenes::battle::{Ride, RidesOptions, ride_all, rides_table};

fn main() -> ExitCode {
    let options = RidesOptions::from_command_line();
    let progress = |ride: &Ride, done: usize, of: usize| {
        let verdict = match &ride.outcome {
            Ok(summary) if summary.holds() => "ok",
            Ok(_) => "a check fails",
            Err(_) => "refused",
        };
        eprintln!("{done:3} of {of}  {:<30} {verdict}", ride.model);
    };
    match ride_all(&options, progress) {
        Ok(rides) => {
            println!("{}", rides_table(&rides));
            let fails = |ride: &Ride| ride.outcome.is_ok() && !ride.holds();
            if rides.iter().any(fails) {
                return ExitCode::FAILURE;
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("rides: {error}");
            ExitCode::from(2)
        }
    }
}
