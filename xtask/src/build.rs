//! One build for tests, examples and benches: with another selection of packages or features, cargo would
//! build the dependencies anew.

use std::collections::{BTreeMap, BTreeSet};

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Message, Metadata, TargetKind};

use crate::run::cargo_output;

/// The whole workspace, with what is not on by default but needed by an example, a test or a bench, or only adds to
/// what there is.
pub(crate) const SELECTION: [&str; 3] = [
    "--workspace",
    "--features",
    "bevy_clamber/clamber_gltf,bevy_clamber/diagnostics,bevy_clamber/gizmos,bevy_clamber/picking,\
        clamber/parry,clamber/record,clamber/render",
];

/// The features that [`SELECTION`] turns on beside the default ones, as `package/feature`.
pub(crate) fn selected(metadata: &Metadata) -> BTreeSet<String> {
    let mut selected = BTreeSet::new();
    let mut next: Vec<String> = SELECTION[2].split(',').map(str::to_owned).collect();
    while let Some(feature) = next.pop() {
        let (package, name) = feature.split_once('/').unwrap_or_default();
        let packages = metadata.workspace_packages();
        let package = packages.iter().find(|known| known.name == package);
        let implied = package.and_then(|package| package.features.get(name));
        next.extend(implied.into_iter().flatten().cloned());
        selected.insert(feature);
    }
    selected
}

/// Builds examples; gives their binaries by name. `which` are cargo's words: `--examples` for all.
pub(crate) fn examples(which: &[&str]) -> Result<BTreeMap<String, Utf8PathBuf>, String> {
    let build = [
        "build",
        "--quiet",
        "--message-format",
        "json-render-diagnostics",
    ];
    let messages = cargo_output(&[&build[..], &SELECTION, which].concat())?;
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
