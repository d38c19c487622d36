//! Commands.

use std::process::{Command, Stdio};

use cargo_metadata::camino::Utf8Path;

/// Where all features are built: those of `bevy_clamber` that speak to other engines bring in Bevy's umbrella crate,
/// which declares a newer Rust than ours and builds on ours.
pub(crate) const IGNORE_RUST_VERSION: &str = "--ignore-rust-version";

/// Runs cargo; an error if it fails.
pub(crate) fn cargo(arguments: &[&str]) -> Result<(), String> {
    cargo_with(arguments, &[])
}

/// Runs cargo with environment variables.
pub(crate) fn cargo_with(arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    println!("   cargo {}", arguments.join(" "));
    let status = command(arguments)
        .envs(variables.iter().copied())
        .status()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!(
            "`cargo {}` ended with {status}",
            arguments.join(" ")
        ))
    }
}

/// Runs cargo and gives what it prints on standard output.
pub(crate) fn cargo_output(arguments: &[&str]) -> Result<String, String> {
    println!("   cargo {}", arguments.join(" "));
    let output = command(arguments)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!(
            "`cargo {}` ended with {}",
            arguments.join(" "),
            output.status
        ))
    }
}

/// Runs cargo for a program that must end with an error of its own, not a panic; gives what it prints on standard
/// error.
pub(crate) fn cargo_refuses(arguments: &[&str]) -> Result<String, String> {
    println!("   cargo {}", arguments.join(" "));
    let output = command(arguments)
        .stdout(Stdio::null())
        .output()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.code() == Some(1) {
        Ok(said)
    } else {
        Err(format!(
            "`cargo {}` ended with {} where 1 was due:\n{said}",
            arguments.join(" "),
            output.status
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

fn command(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(arguments);
    command
}
