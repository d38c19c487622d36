//! One build for tests, examples and benches: with another selection of packages or features, cargo would
//! build the dependencies anew.

use std::collections::BTreeMap;

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Message, TargetKind};

use crate::run::cargo_output;

/// The whole workspace, with what is not on by default but needed by an example, a test or a bench.
/// `.ci/run` tests with the same.
pub(crate) const SELECTION: [&str; 3] =
    ["--workspace", "--features", "clamber/record,clamber/render"];

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
