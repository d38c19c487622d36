//! A bot climbs many models to the highest place that their graphs call reachable.
//!
//! `cargo run --release --example climbs -- --help` lists the options. The climbs themselves are
//! `clamber_scenes::climbs`.

use std::process::ExitCode;

use clamber_scenes::climbs::{Climb, ClimbsOptions, climb_all, table};

/// Least share of the models that the bot has to climb: 20 of 27.
const ENOUGH: f64 = 0.74;

fn main() -> ExitCode {
    let options = ClimbsOptions::from_command_line();
    let progress = |climb: &Climb, done: usize, of: usize| {
        let verdict = match &climb.outcome {
            Ok(climbed) if climbed.times[1].is_some() => "there",
            Ok(climbed) if climbed.heights[1] == 0.0 => "cannot be got onto",
            Ok(_) => "did not come there",
            Err(_) => "refused",
        };
        eprintln!("{done:3} of {of}  {:<30} {verdict}", climb.model);
    };
    match climb_all(&options, progress) {
        Ok(climbs) => {
            println!("{}", table(&climbs));
            let climbed = climbs
                .iter()
                .filter_map(|climb| climb.outcome.as_ref().ok());
            let there = climbed.clone().filter(|climbed| climbed.times[1].is_some());
            if (there.count() as f64) < ENOUGH * climbed.count() as f64 {
                return ExitCode::FAILURE;
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("climbs: {error}");
            ExitCode::from(2)
        }
    }
}
