//! Runs cargo and other programs.

use std::io::{BufRead, BufReader, IsTerminal};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use cargo_metadata::camino::Utf8Path;

/// Option of builds with all features. Features of `bevy_clamber` for other engines bring in Bevy's umbrella crate,
/// which declares a newer Rust than ours but builds with ours.
pub(crate) const IGNORE_RUST_VERSION: &str = "--ignore-rust-version";

/// Beginning of a line on standard error with which a test reports that it was skipped, and why.
const SKIPPED: &str = "SKIPPED";

/// The lines with [`SKIPPED`] of all commands so far.
static SKIPPED_LINES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Keeps a line for the summary if it reports a skipped test.
pub(crate) fn note_skipped(line: &str) {
    if line.starts_with(SKIPPED) {
        let mut lines = SKIPPED_LINES.lock().unwrap_or_else(PoisonError::into_inner);
        lines.push(line.to_owned());
    }
}

/// The lines of all skipped tests so far, each once.
pub(crate) fn skipped() -> Vec<String> {
    let mut lines = SKIPPED_LINES
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clone();
    lines.sort();
    lines.dedup();
    lines
}

/// Runs cargo; an error if it fails.
pub(crate) fn cargo<S: AsRef<str>>(arguments: &[S]) -> Result<(), String> {
    cargo_with(arguments, &[])
}

/// Runs cargo with environment variables.
pub(crate) fn cargo_with<S: AsRef<str>>(
    arguments: &[S],
    variables: &[(&str, &str)],
) -> Result<(), String> {
    let line = line(arguments);
    println!("   {line}");
    let start = Instant::now();
    let failed = |error: std::io::Error| format!("cannot run cargo: {error}");
    let mut command = command(arguments);
    command.envs(variables.iter().copied());
    if std::io::stderr().is_terminal() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    let mut child = command.stderr(Stdio::piped()).spawn().map_err(failed)?;
    for line in child
        .stderr
        .take()
        .into_iter()
        .flat_map(|pipe| BufReader::new(pipe).split(b'\n'))
    {
        let line = String::from_utf8_lossy(&line.map_err(failed)?).into_owned();
        eprintln!("{line}");
        note_skipped(&line);
    }
    let status = child.wait().map_err(failed)?;
    println!("   {:.0} s", start.elapsed().as_secs_f64());
    if status.success() {
        Ok(())
    } else {
        Err(format!("`{line}` ended with {status}"))
    }
}

/// Runs cargo and returns its standard output; an error if it fails.
pub(crate) fn cargo_output<S: AsRef<str>>(arguments: &[S]) -> Result<String, String> {
    let line = line(arguments);
    println!("   {line}");
    let output = command(arguments)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!("`{line}` ended with {}", output.status))
    }
}

/// Runs cargo for a program that must end with exit code 1, not with a panic; returns its standard error.
pub(crate) fn cargo_refuses<S: AsRef<str>>(arguments: &[S]) -> Result<String, String> {
    let line = line(arguments);
    println!("   {line}");
    let output = command(arguments)
        .stdout(Stdio::null())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() == Some(1) {
        Ok(said)
    } else {
        let status = output.status;
        Err(format!(
            "`{line}` ended with {status} where 1 was due:\n{said}"
        ))
    }
}

/// Runs a program in the workspace's root; an error if it fails.
pub(crate) fn program(binary: &Utf8Path, arguments: &[&str]) -> Result<(), String> {
    let name = binary.file_name().unwrap_or(binary.as_str());
    println!("   {name} {}", arguments.join(" "));
    let status = Command::new(binary)
        .args(arguments)
        .stdout(Stdio::null())
        .status()
        .map_err(|error| format!("cannot start {binary}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!(
            "`{binary} {}` ended with {status}",
            arguments.join(" ")
        ))
    }
}

/// Runs a program that must end with exit code 1 or 2 and print this reason on standard error.
pub(crate) fn refuses(binary: &Utf8Path, arguments: &[&str], reason: &str) -> Result<(), String> {
    let name = binary.file_name().unwrap_or(binary.as_str());
    println!("   {name} {} (refused)", arguments.join(" "));
    let output = Command::new(binary)
        .args(arguments)
        .output()
        .map_err(|error| format!("cannot start {binary}: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if matches!(output.status.code(), Some(1 | 2)) && said.contains(reason) {
        return Ok(());
    }
    let (arguments, status) = (arguments.join(" "), output.status);
    Err(format!(
        "`{binary} {arguments}` should be refused with {reason:?}; it ended with {status}:\n{said}"
    ))
}

/// A call of cargo as typed in a shell.
fn line<S: AsRef<str>>(arguments: &[S]) -> String {
    let words = arguments.iter().map(AsRef::as_ref);
    ["cargo"]
        .into_iter()
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

fn command<S: AsRef<str>>(arguments: &[S]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(arguments.iter().map(AsRef::as_ref));
    command
}
