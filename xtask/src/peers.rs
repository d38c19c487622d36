//! Checks `peers`, a workspace of its own, which compares the answers and times of other libraries with ours. Libraries
//! that Debian packages are built if they are installed.

use std::path::Path;

use cargo_metadata::Metadata;

use crate::build::owned;
use crate::run::cargo;
use crate::test_run::{self, Targets, TestRun};

/// Manifest of the workspace, from the root of the repository.
const WORKSPACE: &str = "peers/Cargo.toml";

/// Features for libraries, each with the folder of its headers and its Debian package. Cargo compiles Jolt and PhysX,
/// which takes minutes in each profile, so they are run by hand, as `peers/README.md` says.
const LIBRARIES: [(&str, &str, &str); 3] = [
    ("bullet", "/usr/include/bullet", "libbullet-dev"),
    ("embree", "/usr/include/embree3", "libembree-dev"),
    ("fcl", "/usr/include/fcl", "libfcl-dev"),
];

/// True if a library's headers are installed.
fn is_here((_, headers, _): &&(&str, &str, &str)) -> bool {
    Path::new(headers).exists()
}

/// Runs the tests, and each bench briefly, with the installed libraries. [`rest`] fails if a library is missing.
pub(crate) fn runs() -> Vec<TestRun> {
    let tests = TestRun {
        workspace: WORKSPACE,
        features: LIBRARIES
            .iter()
            .map(|(name, ..)| format!("clamber_peers/{name}"))
            .collect(),
        options: owned(&["--locked"]),
        perform: |metadata, run| test_run::test(metadata, &installed(run)),
        ..TestRun::default()
    };
    let benches = TestRun {
        harness: &["--test"],
        ..tests.clone().of(vec![Targets::Benches])
    };
    vec![tests, benches]
}

/// The run without the libraries that are not installed.
fn installed(run: &TestRun) -> TestRun {
    let mut run = run.clone();
    let missing = LIBRARIES.iter().filter(|library| !is_here(library));
    for (name, ..) in missing {
        run.features
            .retain(|feature| *feature != format!("clamber_peers/{name}"));
    }
    run
}

/// Checks format and lints; then fails if a library is missing.
pub(crate) fn rest(_: &Metadata) -> Result<(), String> {
    cargo(&["fmt", "--manifest-path", WORKSPACE, "--check"])?;
    let all = runs().into_iter().next().unwrap_or_default();
    let lints = installed(&all.of(vec![Targets::All]));
    let mut lints = lints.arguments("clippy", &["-D", "warnings"]);
    lints.insert(1, "--quiet".into());
    cargo(&lints)?;
    let missing = LIBRARIES.iter().filter(|library| !is_here(library));
    let missing: Vec<&str> = missing.map(|(.., package)| *package).collect();
    if missing.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "peers are left out: apt-get install {}",
            missing.join(" ")
        ))
    }
}
