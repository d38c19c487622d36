//! Compares the public items of each published crate with a stored list, so that each change is noticed.
//!
//! Traits that a type implements share one line, without their functions, which follow from the trait. The lists come
//! from rustdoc's JSON. A stable rustdoc writes it only if `RUSTC_BOOTSTRAP` makes it act as a nightly one.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, ExitCode};

use cargo_metadata::Metadata;
use public_api::Builder;

use crate::process::{IGNORE_RUST_VERSION, cargo, cargo_path};
use crate::workspace::{differences, no_faults, published};

/// Folder of the lists.
const FOLDER: &str = "xtask/face";

/// Environment variable that makes this program act as rustdoc.
const AS_RUSTDOC: &str = "CLAMBER_XTASK_AS_RUSTDOC";

/// Checks that each crate has exactly the items of its list.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let mut changes = Vec::new();
    for (name, found) in faces(metadata)? {
        let stored = std::fs::read_to_string(format!("{FOLDER}/{name}.txt")).unwrap_or_default();
        let lines = differences(&stored, &found).into_iter();
        changes.extend(lines.map(|line| format!("{name}: {line}")));
    }
    let hint = ": describe the changes in CHANGELOG.md, then `cargo xtask face`";
    no_faults(&changes, hint)
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

/// The name of each published crate, with the list of its public items, one per line.
fn faces(metadata: &Metadata) -> Result<Vec<(String, String)>, String> {
    let this = std::env::current_exe().map_err(|error| format!("path of xtask: {error}"))?;
    // Of the flags for JSON, `as_rustdoc` adds the other one: flags in a variable would need a blank.
    let variables = format!("RUSTDOC={} RUSTDOCFLAGS=-Zunstable-options", this.display());
    let all = format!("--workspace --all-features {IGNORE_RUST_VERSION}");
    cargo(&format!(
        "{AS_RUSTDOC}=1 {variables} doc --no-deps --quiet {all}"
    ))?;
    let faces = published(metadata).into_iter().map(|package| {
        let name = package.name.to_string();
        let json = metadata.target_directory.join(format!("doc/{name}.json"));
        let items = Builder::from_rustdoc_json(&json)
            .omit_blanket_impls(true)
            .omit_auto_trait_impls(true)
            .build();
        let items = items.map_err(|error| format!("{json}: {error}"))?;
        Ok((name, face(&items.to_string())))
    });
    faces.collect()
}

/// The items, each once, with one line for all traits that a type implements in the same way.
fn face(items: &str) -> String {
    let (mut lines, mut traits) = (Vec::new(), BTreeMap::<_, BTreeSet<&str>>::new());
    let mut implementer = None;
    for line in items.lines() {
        if line.starts_with("impl") {
            implementer =
                implemented(line).map(|(of, ..)| of.split(" where ").next().unwrap_or(of));
        }
        let function = line
            .strip_prefix("pub fn ")
            .or(line.strip_prefix("pub unsafe fn "));
        let after = function.and_then(|path| path.strip_prefix(implementer?));
        if let Some((of, generics, name)) = implemented(line) {
            traits.entry((of, generics)).or_default().insert(name);
        } else if !after.is_some_and(|rest| rest.starts_with("::")) {
            lines.push(line.to_owned());
        }
    }
    lines.extend(traits.iter().map(|((of, generics), names)| {
        let names: Vec<&str> = names.iter().copied().collect();
        format!("impl{generics} {} for {of}", names.join(", "))
    }));
    let mut seen = BTreeSet::new();
    lines.retain(|line| seen.insert(line.clone()));
    lines.join("\n") + "\n"
}

/// The type, the generics and the trait without its path of a line `impl<generics> path::Trait for type`.
fn implemented(line: &str) -> Option<(&str, &str, &str)> {
    let (head, of) = line.strip_prefix("impl")?.split_once(" for ")?;
    // The blank in front of the trait is the first one outside of angle brackets. Arrows are no brackets.
    let mut open = 0;
    let at = head.replace("->", "  ").find(|c| {
        open += i32::from(c == '<') - i32::from(c == '>');
        c == ' ' && open == 0
    })?;
    let path = &head[at + 1..];
    let start = path.split('<').next()?.rfind("::").map_or(0, |at| at + 2);
    Some((of, &head[..at], &path[start..]))
}

/// Runs rustdoc with unstable options if cargo called this program in its place; `None` for any other call.
///
/// Only rustdoc gets the variable that allows these options: if cargo saw it, half of all crates would be built again.
pub(crate) fn as_rustdoc() -> Option<ExitCode> {
    std::env::var_os(AS_RUSTDOC)?;
    // The rustdoc of the toolchain whose cargo runs, if it is there; otherwise the one in the path.
    let beside = Path::new(&cargo_path()).with_file_name("rustdoc");
    let mut rustdoc = Command::new(if beside.exists() {
        &beside
    } else {
        Path::new("rustdoc")
    });
    rustdoc
        .args(std::env::args_os().skip(1))
        .env("RUSTC_BOOTSTRAP", "1");
    // Cargo asks for the version with this option alone.
    if std::env::args_os().all(|word| word != "-vV") {
        rustdoc.args(["--output-format", "json"]);
    }
    let is_done = rustdoc.status().is_ok_and(|status| status.success());
    Some(if is_done {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

#[cfg(test)]
mod tests {
    use super::face;

    #[test]
    fn traits_share_a_line() {
        let items = "\
impl a::B
pub fn a::B::new() -> a::B
impl core::clone::Clone for a::B
pub fn a::B::clone(&self) -> a::B
impl<T: Fn() -> u8> core::convert::From<T> for a::B
impl core::ops::Add for a::B
pub type a::B::Output = a::B
pub fn a::B::add(self, a::B) -> a::B
pub fn a::Bfree()";
        let own = "impl a::B\npub fn a::B::new() -> a::B\npub type a::B::Output = a::B\n";
        let due =
            "pub fn a::Bfree()\nimpl Add, Clone for a::B\nimpl<T: Fn() -> u8> From<T> for a::B\n";
        assert_eq!(face(items), format!("{own}{due}"));
    }
}
