//! One build for tests, examples and benches: with another selection of packages or features, cargo would
//! build the dependencies anew.

use std::collections::{BTreeMap, BTreeSet};

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Message, Metadata, TargetKind};

use crate::run::{IGNORE_RUST_VERSION, cargo_output};

/// What is not on by default but needed by an example, a test or a bench, or only adds to what there is.
const FEATURES: &str = "\
    bevy_clamber/clamber_gltf,bevy_clamber/diagnostics,bevy_clamber/fight,bevy_clamber/gizmos,bevy_clamber/gltf,\
    bevy_clamber/input,bevy_clamber/picking,clamber/record,clamber/render,clamber_benches/record,clamber_benches/render,\
    clamber_climber/serde,clamber/ggrs,clamber_oracle/exact";

/// The packages whose tests `cargo test` runs in full: the workspace's default members, but for the oracle, which has
/// more tests with its feature.
const DEFAULT: [&str; 7] = [
    "clamber",
    "clamber_animation",
    "clamber_climber",
    "clamber_gltf",
    "clamber_mover",
    "clamber_surface",
    "clamber_world",
];

/// Golden runs as released, with SIMD levels down to scalar code. Here, since scalar code with overflow checks takes as
/// long to compile as all other levels together, and there are none in sums of floats. One selection for all of them:
/// with another one, cargo would build rapier again.
pub(crate) const RELEASED: [&str; 9] = [
    "--release",
    "-p",
    "clamber",
    "-p",
    "clamber_climber",
    "-p",
    "clamber_surface",
    "--features",
    "clamber_surface/scalar",
];

/// The whole workspace, with [`FEATURES`].
pub(crate) fn selection() -> Vec<&'static str> {
    vec!["--workspace", IGNORE_RUST_VERSION, "--features", FEATURES]
}

/// [`selection`] for tests of packages that are not [`DEFAULT`] members. The libraries are built alike.
pub(crate) fn beyond_default() -> Vec<&'static str> {
    let excluded = DEFAULT.iter().flat_map(|package| ["--exclude", *package]);
    selection().into_iter().chain(excluded).collect()
}

/// The features that are on with [`selection`], as `package/feature`: those named, those on by default, and what
/// they turn on in turn.
pub(crate) fn selected(metadata: &Metadata) -> BTreeSet<String> {
    let packages = metadata.workspace_packages();
    let default = packages
        .iter()
        .map(|package| format!("{}/default", package.name));
    let named = FEATURES.split(',');
    let mut next: Vec<String> = named.map(str::to_owned).chain(default).collect();
    let mut selected = BTreeSet::new();
    while let Some(feature) = next.pop() {
        let (package, name) = feature.split_once('/').unwrap_or_default();
        let known = packages.iter().find(|known| known.name == package);
        let implied = known.and_then(|known| known.features.get(name));
        for implied in implied.into_iter().flatten() {
            next.push(if implied.contains('/') || implied.starts_with("dep:") {
                implied.clone()
            } else {
                format!("{package}/{implied}")
            });
        }
        selected.insert(feature);
    }
    selected
}

/// Builds all examples of a selection, or those that it names; gives their binaries by name.
pub(crate) fn examples(which: &[&str]) -> Result<BTreeMap<String, Utf8PathBuf>, String> {
    let build = [
        "build",
        "--quiet",
        "--message-format",
        "json-render-diagnostics",
    ];
    let all: &[&str] = match which.contains(&"--example") {
        true => &[],
        false => &["--examples"],
    };
    let messages = cargo_output(&[&build[..], which, all].concat())?;
    let mut examples = BTreeMap::new();
    for message in Message::parse_stream(messages.as_bytes()) {
        let message = message.map_err(|error| format!("what cargo says of its build: {error}"))?;
        if let Message::CompilerArtifact(artifact) = message
            && artifact.target.kind.contains(&TargetKind::Example)
            && let Some(binary) = artifact.executable
        {
            examples.insert(artifact.target.name, binary);
        }
    }
    Ok(examples)
}
