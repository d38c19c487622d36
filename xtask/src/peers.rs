//! `peers`, a workspace of its own: other libraries, whose answers and times are held against ours. Of those that Debian
//! packages, what is installed is built.

use std::path::Path;

use crate::run::cargo;

const MANIFEST: [&str; 3] = ["--locked", "--manifest-path", "peers/Cargo.toml"];

/// Features, where their headers are, and in which package. Jolt and PhysX, which cargo compiles, take minutes in each
/// profile: they are run by hand, as `peers/README.md` says.
const LIBRARIES: [(&str, &str, &str); 3] = [
    ("bullet", "/usr/include/bullet", "libbullet-dev"),
    ("embree", "/usr/include/embree3", "libembree-dev"),
    ("fcl", "/usr/include/fcl", "libfcl-dev"),
];

/// Format, lints, tests, and each bench briefly; fails if a library is missing, after it has checked the rest.
pub(crate) fn check() -> Result<(), String> {
    let here = |(_, headers, _): &&(&str, &str, &str)| Path::new(headers).exists();
    let installed: Vec<&str> = LIBRARIES
        .iter()
        .filter(here)
        .map(|(name, ..)| *name)
        .collect();
    let installed = installed.join(",");
    let features = ["--features", &installed];
    cargo(&["fmt", "--manifest-path", MANIFEST[2], "--check"])?;
    let strict = ["--", "-D", "warnings"];
    cargo(
        &[
            &["clippy", "--all-targets", "--quiet"][..],
            &MANIFEST,
            &features,
            &strict,
        ]
        .concat(),
    )?;
    cargo(&[&["test"][..], &MANIFEST, &features].concat())?;
    let brief = ["--benches", "--", "--test"];
    cargo(&[&["test"][..], &MANIFEST, &features, &brief].concat())?;
    let missing = LIBRARIES.iter().filter(|library| !here(library));
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
