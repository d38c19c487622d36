//! Compares the public items of each published crate with a stored list, so that each change is noticed.
//!
//! The lists come from rustdoc's JSON. A stable rustdoc writes it only if `RUSTC_BOOTSTRAP` makes it act as a nightly
//! one.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, ExitCode};

use cargo_metadata::Metadata;
use cargo_metadata::camino::Utf8PathBuf;
use public_api::Builder;

use crate::features::published;
use crate::run::{IGNORE_RUST_VERSION, cargo_with};

/// Folder of the lists.
const FOLDER: &str = "xtask/face";

/// Environment variable that makes this program act as rustdoc.
const AS_RUSTDOC: &str = "CLAMBER_XTASK_AS_RUSTDOC";

/// Checks that each crate has exactly the items of its list.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let mut differences = Vec::new();
    for (name, found) in faces(metadata)? {
        let path = format!("{FOLDER}/{name}.txt");
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        differences.extend(compare(&name, &stored, &found));
    }
    if differences.is_empty() {
        return Ok(());
    }
    for line in &differences {
        println!("   {line}");
    }
    Err(format!(
        "{} public items changed: describe them in CHANGELOG.md, then `cargo xtask face`",
        differences.len()
    ))
}

/// Stores the lists.
pub(crate) fn store(metadata: &Metadata) -> Result<(), String> {
    for (name, found) in faces(metadata)? {
        let path = format!("{FOLDER}/{name}.txt");
        std::fs::write(&path, &found).map_err(|error| format!("{path}: {error}"))?;
        println!("   {path}: {} items", found.lines().count());
    }
    Ok(())
}

/// The lines that only one of two lists has: `-` for the stored list, `+` for the found one.
fn compare(name: &str, stored: &str, found: &str) -> Vec<String> {
    let [stored, found] = [stored, found].map(|text| text.lines().collect::<BTreeSet<_>>());
    let gone = stored
        .difference(&found)
        .map(|line| format!("{name}: - {line}"));
    let new = found
        .difference(&stored)
        .map(|line| format!("{name}: + {line}"));
    gone.chain(new).collect()
}

/// The name of each published crate, with the list of its public items, one per line.
fn faces(metadata: &Metadata) -> Result<Vec<(String, String)>, String> {
    document()?;
    let faces = published(metadata).map(|package| {
        let name = package.name.to_string();
        let json: Utf8PathBuf = metadata.target_directory.join(format!("doc/{name}.json"));
        let items = Builder::from_rustdoc_json(&json)
            .omit_blanket_impls(true)
            .omit_auto_trait_impls(true)
            .build()
            .map_err(|error| format!("{json}: {error}"))?;
        Ok((name, items.to_string()))
    });
    faces.collect()
}

/// Makes rustdoc write the JSON of each crate, with all features.
fn document() -> Result<(), String> {
    let this =
        std::env::current_exe().map_err(|error| format!("where is this program? {error}"))?;
    let this = this.to_string_lossy();
    let doc = [
        "doc",
        "--workspace",
        "--no-deps",
        "--all-features",
        IGNORE_RUST_VERSION,
        "--quiet",
    ];
    let variables = [
        ("RUSTDOC", this.as_ref()),
        ("RUSTDOCFLAGS", "-Z unstable-options --output-format json"),
        (AS_RUSTDOC, "1"),
    ];
    cargo_with(&doc, &variables)
}

/// Runs rustdoc with unstable options if cargo called this program in its place; `None` for any other call.
///
/// Only rustdoc gets the variable that allows these options: if cargo saw it, half of all crates would be built again.
pub(crate) fn as_rustdoc() -> Option<ExitCode> {
    std::env::var_os(AS_RUSTDOC)?;
    let mut rustdoc = Command::new(rustdoc_beside_cargo());
    rustdoc.args(std::env::args_os().skip(1));
    rustdoc.env("RUSTC_BOOTSTRAP", "1");
    let done = rustdoc.status();
    Some(match done {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("cannot start rustdoc: {error}");
            ExitCode::FAILURE
        }
    })
}

/// The rustdoc of the toolchain whose cargo runs, if it is there; otherwise the rustdoc in the path.
fn rustdoc_beside_cargo() -> std::ffi::OsString {
    let cargo = std::env::var_os("CARGO").unwrap_or_default();
    let beside = Path::new(&cargo).with_file_name("rustdoc");
    if beside.exists() {
        beside.into()
    } else {
        "rustdoc".into()
    }
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn tells_what_is_gone_and_what_is_new() {
        let told = compare("mesh", "fn a()\nfn b()\n", "fn a()\nfn c()\n");
        assert_eq!(told, ["mesh: - fn b()", "mesh: + fn c()"]);
    }
}
