//! The sweeps against files of continuous collision queries whose exact answers are known.
//!
//! `ccd_queries FILE.csv...`; `--help` describes the files. How answers are judged is in
//! `clamber_fuzz::ccd`.

use std::process::ExitCode;

use clamber_fuzz::ccd::{self, CcdOptions};

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
        eprintln!("ccd_queries: an answer is false");
        ExitCode::FAILURE
    }
}
