//! One build for tests, examples and benches: with another selection of packages or features, cargo would
//! build the dependencies anew.

use std::collections::BTreeMap;

use cargo_metadata::camino::Utf8PathBuf;
use cargo_metadata::{Message, Metadata, TargetKind};

use crate::run::{IGNORE_RUST_VERSION, cargo_output};
use crate::test_run::{Packages, Profile, TestRun};

/// What is not on by default but needed by an example, a test or a bench, or only adds to what there is. With
/// `deterministic`, battles have the same hashes as [`released`]. It costs no further build of rapier: Bevy has glam
/// built anew for all of this anyway.
const FEATURES: [&str; 16] = [
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
    "clamber_oracle/exact",
];

/// The default member that has more tests with its feature. Those of the others, `cargo test` runs in full.
const ORACLE: &str = "clamber_oracle";

/// The packages whose golden runs are run as released.
const RELEASED: [&str; 3] = ["clamber", "clamber_climber", "clamber_surface"];

/// The whole workspace, with [`FEATURES`].
pub(crate) fn selection() -> TestRun {
    TestRun {
        packages: Packages::AllBut(Vec::new()),
        features: owned(&FEATURES),
        options: owned(&[IGNORE_RUST_VERSION]),
        ..TestRun::default()
    }
}

/// [`selection`] for tests of packages whose tests `cargo test` does not run in full. The libraries are built alike.
pub(crate) fn beyond_default(metadata: &Metadata) -> TestRun {
    let default = metadata.workspace_default_packages().into_iter();
    let names = default.map(|package| package.name.to_string());
    TestRun {
        packages: Packages::AllBut(names.filter(|name| name != ORACLE).collect()),
        ..selection()
    }
}

/// Golden runs as released, with SIMD levels down to scalar code. Here, since scalar code with overflow checks takes as
/// long to compile as all other levels together, and there are none in sums of floats. One selection for all of them:
/// with another one, cargo would build rapier again. The hashes of battles are stored for `deterministic`.
pub(crate) fn released() -> TestRun {
    TestRun {
        profile: Profile::Release,
        packages: Packages::Named(owned(&RELEASED)),
        features: owned(&["clamber/deterministic", "clamber_surface/scalar"]),
        ..TestRun::default()
    }
}

/// As the lists of a [`TestRun`] are.
pub(crate) fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

/// Builds the examples that a selection has for targets; gives their binaries by name.
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
