//! Tests the sweeps with files of continuous collision queries whose exact answers are known.
//!
//! Usage: `ccd_queries FILE.csv...`. `--help` describes the files; `clamber_verify::ccd` describes how the answers are
//! judged.

use std::process::ExitCode;

use clamber_verify::ccd::{self, CcdOptions};

fn main() -> ExitCode {
    let options = CcdOptions::from_command_line();
    let report = match ccd::run(&options) {
        Ok(report) => report,
        Err(error) => {
            eprintln!("ccd_queries: {error}");
            return ExitCode::from(2);
        }
    };
    if options.json {
        println!("{}", report.to_json());
    } else {
        print!("{report}");
    }
    if report.holds() {
        ExitCode::SUCCESS
    } else {
        eprintln!("ccd_queries: an answer is wrong or unproved");
        ExitCode::FAILURE
    }
}
