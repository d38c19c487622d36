//! Tests the sweeps with third-party queries whose exact answers are known.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::path::PathBuf;

use clamber_scenes::test_data;
use clamber_verify::ccd::{CcdOptions, run};

/// Number of files in the test data.
const FILES: usize = 13;

/// Number of queries in the test data.
const QUERIES: usize = 1_909;

/// All query files of the test data.
fn files() -> Vec<PathBuf> {
    let Some(readme) = test_data::file("collision queries", "ccd/README.md") else {
        return Vec::new();
    };
    test_data::files_in(readme.parent().unwrap(), &["csv"]).unwrap()
}

#[test]
fn no_answer_to_a_third_party_query_is_wrong() {
    let files = files();
    if files.is_empty() {
        return;
    }
    assert_eq!(files.len(), FILES, "{files:?}");
    let report = run(&CcdOptions { files, json: false }).unwrap();
    println!("{report}");
    assert!(report.holds(), "{report}");
    assert_eq!(report.queries, QUERIES, "{report}");
    assert!(report.hits > 219 && report.misses > 1_000, "{report}");
}
