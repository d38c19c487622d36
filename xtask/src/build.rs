//! Builds tests, examples and benches with one selection of packages and features. With another selection, cargo would
//! build the dependencies again.

use std::collections::BTreeMap;

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Message, Metadata, TargetKind};

use crate::run::{IGNORE_RUST_VERSION, cargo_output};
use crate::test_run::{Packages, Profile, TestRun};

/// Features that are off by default and that an example, a test or a bench needs, or that only add items. With
/// `deterministic`, battles have the same hashes as with [`released`]. It costs no further build of rapier: with Bevy
/// in the selection, glam is built again anyway.
const FEATURES: [&str; 15] = [
    "bevy_clamber/clamber_gltf",
    "bevy_clamber/diagnostics",
    "bevy_clamber/fight",
    "bevy_clamber/gizmos",
    "bevy_clamber/gltf",
    "bevy_clamber/input",
    "bevy_clamber/picking",
    "clamber/deterministic",
    "clamber/ggrs",
    "clamber/navigation",
    "clamber/record",
    "clamber/render",
    "clamber_benches/record",
    "clamber_benches/render",
    "clamber_climber/serde",
];

/// Packages whose golden runs are run in the release profile.
const RELEASED: [&str; 3] = ["clamber", "clamber_climber", "clamber_surface"];

/// Selects the whole workspace, with [`FEATURES`].
pub(crate) fn selection() -> TestRun {
    TestRun {
        packages: Packages::AllBut(Vec::new()),
        features: owned(&FEATURES),
        options: owned(&[IGNORE_RUST_VERSION]),
        ..TestRun::default()
    }
}

/// [`selection`] for tests of the packages that `cargo test` does not test. The libraries are built as in
/// [`selection`].
pub(crate) fn beyond_default(metadata: &Metadata) -> TestRun {
    let default = metadata.workspace_default_packages().into_iter();
    let names = default.map(|package| package.name.to_string());
    TestRun {
        packages: Packages::AllBut(names.collect()),
        ..selection()
    }
}

/// Selects golden runs in the release profile, with all SIMD levels down to scalar code. Scalar code is tested here
/// because it takes as long to compile with overflow checks as all other levels together, and sums of floats have no
/// such checks. All golden runs share one selection: with another one, cargo would build rapier again. The stored
/// hashes of battles are for `deterministic`.
pub(crate) fn released() -> TestRun {
    TestRun {
        profile: Profile::Release,
        packages: Packages::Named(owned(&RELEASED)),
        features: owned(&["clamber/deterministic", "clamber_surface/scalar"]),
        ..TestRun::default()
    }
}

/// Copies words into the form of a [`TestRun`]'s lists.
pub(crate) fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

/// Builds the examples of a selection; returns the paths of their binaries by name.
pub(crate) fn examples(which: &TestRun) -> Result<BTreeMap<String, Utf8PathBuf>, String> {
    let mut build = which.arguments("build", &[]);
    build.extend(owned(&["--quiet", "--message-format"]));
    build.push("json-render-diagnostics".into());
    let messages = cargo_output(&build)?;
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
