//! Reports what the import finds in a creature's file, and checks the creature in motion.
//!
//! `cargo install --path . --example inspect` installs it for artists; `inspect --help` lists the options. The checks
//! are in `clamber_scenes::inspect`.

use std::process::ExitCode;

use clamber_scenes::inspect::{self, InspectOptions};

fn main() -> ExitCode {
    let options = InspectOptions::from_command_line();
    let inspection = match inspect::run(&options) {
        Ok(inspection) => inspection,
        Err(error) => {
            eprintln!("inspect: {error}");
            return ExitCode::from(2);
        }
    };
    if options.json {
        println!("{}", inspection.to_json());
    } else {
        println!("{}", options.file.display());
        print!("{inspection}");
    }
    if inspection.holds() {
        ExitCode::SUCCESS
    } else {
        eprintln!("inspect: a check failed");
        ExitCode::FAILURE
    }
}
