//! The command `clamber`.

use std::process::ExitCode;

use clamber_cli::climbability::{self, ClimbabilityOptions};
use clamber_cli::compare::{self, CompareOptions};
use clamber_cli::inspect::{self, InspectOptions};
use clap::{Parser, Subcommand};

/// Tools for climbable creatures, and for recordings of climbs.
#[derive(Debug, Parser)]
#[command(name = "clamber", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Inspect(InspectOptions),
    Climbability(ClimbabilityOptions),
    Compare(CompareOptions),
}

fn main() -> ExitCode {
    end_with_reader();
    let ended = match Arguments::parse().command {
        Command::Inspect(options) => inspect::print(&options).map_err(|error| error.to_string()),
        Command::Climbability(options) => {
            climbability::print(&options).map_err(|error| error.to_string())
        }
        Command::Compare(options) => compare::print(&options).map_err(|error| error.to_string()),
    };
    match ended {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("clamber: {error}");
            ExitCode::from(2)
        }
    }
}

/// Exits quietly with 0 when the reader of standard output, such as `head`, has closed it. `println!` panics in that
/// case.
fn end_with_reader() {
    let others = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let text = panic.payload().downcast_ref::<String>();
        if text.is_some_and(|text| text.starts_with("failed printing to stdout")) {
            std::process::exit(0);
        }
        others(panic);
    }));
}
