//! Tests the sweeps with files of continuous collision queries whose exact answers are known.
//!
//! Usage: `ccd_queries FILE.csv...`. `--help` describes the files; `clamber_verify::ccd` describes how the answers are
//! judged.

use std::process::ExitCode;

use clamber_scenes::measure::checked;
use clamber_verify::ccd::{self, CcdOptions};
use clap::Parser;

fn main() -> ExitCode {
    let options = CcdOptions::parse();
    let holds = ccd::run(&options).map(|report| {
        if options.json {
            println!("{}", report.to_json());
        } else {
            print!("{report}");
        }
        report.holds()
    });
    checked("ccd_queries", holds)
}
