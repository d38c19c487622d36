//! Libraries that peers need: of those that Debian packages, what is installed is built, and on CI all of it must be.

use std::path::Path;

/// Features, where their headers are, and in which package.
const LIBRARIES: [(&str, &str, &str); 3] = [
    (
        "clamber_peers/bullet",
        "/usr/include/bullet",
        "libbullet-dev",
    ),
    (
        "clamber_peers/embree",
        "/usr/include/embree3",
        "libembree-dev",
    ),
    ("clamber_peers/fcl", "/usr/include/fcl", "libfcl-dev"),
];

/// Features whose libraries cargo compiles: Jolt and PhysX take minutes in each profile, for one peer each. They are run
/// by hand, as `crates/clamber_peers/README.md` says.
const COMPILED: [&str; 2] = ["clamber_peers/jolt", "clamber_peers/physx"];

/// The features whose libraries are here.
pub(crate) fn installed() -> Vec<&'static str> {
    let here = LIBRARIES
        .iter()
        .filter(|(_, headers, _)| Path::new(headers).exists());
    here.map(|(feature, ..)| *feature).collect()
}

/// True for a feature, `package/feature`, that is not built: its library is not here, or takes minutes to compile.
pub(crate) fn left_out(feature: &str) -> bool {
    let known = LIBRARIES.iter().any(|(known, ..)| *known == feature);
    COMPILED.contains(&feature) || known && !installed().contains(&feature)
}

/// Says what is missing; on CI that is an error.
pub(crate) fn check() -> Result<(), String> {
    let missing = LIBRARIES
        .iter()
        .filter(|(_, headers, _)| !Path::new(headers).exists());
    let missing: Vec<&str> = missing.map(|(.., package)| *package).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let missing = format!("peers are left out: apt-get install {}", missing.join(" "));
    if std::env::var_os("CI").is_some() {
        return Err(missing);
    }
    eprintln!("WARNING: {missing}");
    Ok(())
}
