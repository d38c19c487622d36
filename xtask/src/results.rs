//! Adds the results of nightly steps to a table. Runs of single steps on one commit add up to a whole run.

use std::io::Write;
use std::process::Command;

use cargo_metadata::Metadata;

use crate::steps::Ended;

/// File of the table, in cargo's target folder.
const FILE: &str = "nightly.md";

/// Beginning of the table; its columns are those in `docs/measured.md`.
const HEAD: &str = "| step | commit | seconds | result |\n|---|---|---|---|\n";

/// Adds a line for a step that ended.
pub(crate) fn add(metadata: &Metadata, ended: &Ended) -> Result<(), String> {
    let path = metadata.target_directory.join(FILE);
    let head = if path.exists() { "" } else { HEAD };
    let row = row(ended, &commit());
    let file = std::fs::OpenOptions::new()
        .append(true)
        .create(true)
        .open(&path);
    let written = file.and_then(|mut file| file.write_all(format!("{head}{row}").as_bytes()));
    written.map_err(|error| format!("{path}: {error}"))
}

fn row(ended: &Ended, commit: &str) -> String {
    let result = if ended.passed { "passed" } else { "failed" };
    format!(
        "| {} | {commit} | {:.0} | {result} |\n",
        ended.name, ended.seconds
    )
}

/// The current commit, and whether files differ from it.
fn commit() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok();
        let output = output.filter(|output| output.status.success());
        output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else {
        return "unknown".into();
    };
    let changed = git(&["status", "--porcelain", "--untracked-files=no"]);
    match changed.as_deref() {
        Some("") => commit,
        _ => format!("{commit}, changed"),
    }
}

#[cfg(test)]
mod tests {
    use super::{HEAD, row};
    use crate::steps::Ended;

    #[test]
    fn a_row_has_the_columns_of_the_head() {
        let ended = Ended {
            name: "all cases",
            seconds: 61.4,
            passed: false,
        };
        let row = row(&ended, "0123456789ab");
        assert_eq!(row, "| all cases | 0123456789ab | 61 | failed |\n");
        let head = HEAD.lines().next().unwrap_or_default();
        assert_eq!(row.matches('|').count(), head.matches('|').count());
    }
}
