//! Asks cargo what a call of it would test, bench or run, by the graph of the units that the call would build. Cargo
//! itself so selects packages and targets, and turns features on. A stable cargo prints the graph only if
//! `RUSTC_BOOTSTRAP` makes it act as a nightly one. Nothing is built.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use cargo_metadata::camino::Utf8Path;
use cargo_metadata::{Package, Target};
use serde_json::Value;

use crate::process::{IGNORE_RUST_VERSION, cargo_path, split};

/// Examples that open a window: a step builds them with `--all-targets`, and none runs them.
const WINDOWS: [&str; 2] = ["first", "fox"];

/// A target of a package, run in one way.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Part {
    pub(crate) package: String,
    /// `lib` or `bin` for unit tests, `doctest` for the programs in the documentation, `test`, `bench` or `example`;
    /// `program` for a program that is started.
    pub(crate) kind: &'static str,
    pub(crate) name: String,
}

impl Part {
    pub(crate) fn new(package: &str, kind: &'static str, name: &str) -> Self {
        let (package, name) = (package.to_owned(), name.to_owned());
        Self {
            package,
            kind,
            name,
        }
    }
}

impl std::fmt::Display for Part {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {} of {}", self.kind, self.name, self.package)
    }
}

/// The parts of a package that have to be run, each with its target.
pub(crate) fn parts(package: &Package) -> Vec<(Part, &Target)> {
    let mut parts = Vec::new();
    for target in &package.targets {
        for (kind, is_one) in [
            ("lib", target.is_lib() && target.test),
            ("bin", target.is_bin() && target.test),
            ("doctest", target.doctest),
            ("test", target.is_test()),
            ("bench", target.is_bench()),
            ("example", target.is_example()),
        ] {
            let part = Part::new(&package.name, kind, &target.name);
            parts.extend(is_one.then_some((part, target)));
        }
    }
    parts
}

/// A call of cargo.
#[derive(Clone, Default)]
pub(crate) struct Call {
    pub(crate) parts: BTreeSet<Part>,
    /// The features that are on, as `package/feature`.
    pub(crate) features: BTreeSet<String>,
    /// The words after `--`.
    pub(crate) after: Vec<String>,
}

impl Call {
    /// True if the call runs the tests that are marked as ignored, too.
    pub(crate) fn runs_ignored(&self) -> bool {
        let mut after = self.after.iter();
        after.any(|word| word == "--ignored" || word == "--include-ignored")
    }
}

/// What cargo would run with these words in a folder. An error if they name something that does not exist.
pub(crate) fn ask(folder: &Utf8Path, line: &str) -> Result<Call, String> {
    static CALLS: Mutex<BTreeMap<String, Result<Call, String>>> = Mutex::new(BTreeMap::new());
    let mut calls = CALLS.lock().unwrap_or_else(PoisonError::into_inner);
    let mut words = split(line).1.split_whitespace();
    let before: Vec<&str> = words.by_ref().take_while(|word| *word != "--").collect();
    let known = calls.entry(format!("{folder} {before:?}"));
    let mut call = known.or_insert_with(|| graph(folder, &before)).clone()?;
    call.after = words.map(str::to_owned).collect();
    Ok(call)
}

/// Reads cargo's graph. Its roots are the targets that cargo was asked for.
fn graph(folder: &Utf8Path, words: &[&str]) -> Result<Call, String> {
    let mut cargo = Command::new(cargo_path());
    // `cargo run` has no graph: it builds what `cargo build` would build.
    cargo.arg(words[0].replace("run", "build"));
    cargo.args(
        words[1..]
            .iter()
            .filter(|word| **word != IGNORE_RUST_VERSION),
    );
    cargo.args([IGNORE_RUST_VERSION, "-Zunstable-options", "--unit-graph"]);
    cargo.current_dir(folder).env("RUSTC_BOOTSTRAP", "1");
    let output = cargo.output();
    let output = output.map_err(|error| format!("cannot run cargo: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let graph = serde_json::from_slice::<Value>(&output.stdout);
    let graph = graph.map_err(|error| format!("cargo's graph of units: {error}"))?;
    let all = |list: &Value| list.as_array().cloned().unwrap_or_default();
    let (mut parts, mut features) = (BTreeSet::new(), BTreeSet::new());
    for unit in all(&graph["units"]) {
        for feature in all(&unit["features"]) {
            features.insert(format!("{}/{}", package(&unit), text(&feature)));
        }
    }
    for root in all(&graph["roots"]) {
        let unit = &graph["units"][root.as_u64().unwrap_or_default() as usize];
        let name = text(&unit["target"]["name"]);
        let kind = match (text(&unit["target"]["kind"][0]), text(&unit["mode"])) {
            (_, "doctest") => "doctest",
            ("test", _) => "test",
            ("bench", _) => "bench",
            // Tests build all examples, and do not run them.
            ("example", "build") if words[0] == "test" => continue,
            ("example", "test") if !WINDOWS.contains(&name) => continue,
            ("example", _) => "example",
            ("bin", "build") => "program",
            ("bin", _) => "bin",
            (_, "build") => continue,
            _ => "lib",
        };
        parts.insert(Part::new(package(unit), kind, name));
    }
    let after = Vec::new();
    Ok(Call {
        parts,
        features,
        after,
    })
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// The package of a unit, by its identifier `path+file:///folder#name@version`, or `path+file:///name#version`.
fn package(unit: &Value) -> &str {
    let (path, version) = text(&unit["pkg_id"]).rsplit_once('#').unwrap_or_default();
    let name = version.split_once('@').map(|(name, _)| name);
    name.unwrap_or(path.rsplit('/').next().unwrap_or_default())
}
