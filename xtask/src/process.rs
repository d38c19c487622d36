//! Starts cargo and other programs, and collects the lines with which tests report that they were skipped. Blanks
//! separate the words of a command line, so no path in it may have any.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, IsTerminal};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// Option of builds with all features. Features of `bevy_clamber` for other engines bring in Bevy's umbrella crate,
/// which declares a newer Rust than ours but builds with ours.
pub(crate) const IGNORE_RUST_VERSION: &str = "--ignore-rust-version";

/// The reports of skipped tests so far, for the summary.
pub(crate) static SKIPPED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// Keeps a line of standard error if it is the report of a skipped test.
pub(crate) fn note_skipped(line: &str) {
    if line.starts_with("SKIPPED") {
        let mut lines = SKIPPED.lock().unwrap_or_else(PoisonError::into_inner);
        lines.insert(line.to_owned());
    }
}

/// The cargo that started this program.
pub(crate) fn cargo_path() -> String {
    std::env::var("CARGO").unwrap_or_else(|_| "cargo".into())
}

/// The environment variables in front of a line, as in `A=1 B=2 test --lib`, and the words that follow them.
pub(crate) fn split(line: &str) -> (Vec<(&str, &str)>, &str) {
    let (mut variables, mut rest) = (Vec::new(), line);
    while let Some((word, after)) = rest.split_once(' ') {
        let Some(variable) = word.split_once('=') else {
            break;
        };
        variables.push(variable);
        rest = after;
    }
    (variables, rest)
}

/// Runs cargo and shows its output. Environment variables may stand in front of the words.
pub(crate) fn cargo(line: &str) -> Result<(), String> {
    println!("   cargo {line}");
    let (variables, words) = split(line);
    let mut command = Command::new(cargo_path());
    command.args(words.split_whitespace()).envs(variables);
    if std::io::stderr().is_terminal() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    let failed = |error: std::io::Error| format!("cannot run cargo: {error}");
    let mut child = command.stderr(Stdio::piped()).spawn().map_err(failed)?;
    let errors = child.stderr.take().into_iter();
    for line in errors.flat_map(|pipe| BufReader::new(pipe).split(b'\n')) {
        let line = String::from_utf8_lossy(&line.map_err(failed)?).into_owned();
        eprintln!("{line}");
        note_skipped(&line);
    }
    let status = child.wait().map_err(failed)?;
    let failed = || format!("`cargo {line}` ended with {status}");
    status.success().then_some(()).ok_or_else(failed)
}

/// Runs a program and returns its standard output.
pub(crate) fn run(program: &str, line: &str) -> Result<String, String> {
    output(program, line, |code, _| code == 0)
}

/// Runs a program that must end with exit code 1 or 2 and print this reason on standard error.
pub(crate) fn refuses(program: &str, line: &str, reason: &str) -> Result<(), String> {
    let is_due = |code, errors: &str| matches!(code, 1 | 2) && errors.contains(reason);
    let refused = output(program, line, is_due).map(drop);
    refused.map_err(|error| format!("should be refused with {reason:?}: {error}"))
}

/// Runs a program and returns its standard output. An error if exit code and standard error are not as they should be.
fn output(program: &str, line: &str, is_due: impl Fn(i32, &str) -> bool) -> Result<String, String> {
    let name = program.rsplit(['/', '\\']).next().unwrap_or(program);
    println!("   {name} {line}");
    let output = Command::new(program).args(line.split_whitespace()).output();
    let output = output.map_err(|error| format!("cannot start {program}: {error}"))?;
    let errors = String::from_utf8_lossy(&output.stderr);
    errors.lines().for_each(note_skipped);
    match output.status.code() {
        Some(code) if is_due(code, &errors) => {
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        }
        _ => Err(format!(
            "`{name} {line}` ended with {}:\n{errors}",
            output.status
        )),
    }
}
