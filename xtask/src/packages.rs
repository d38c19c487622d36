//! Checks each published crate as crates.io would get it: its metadata, its licences, and its list of files. The
//! nightly task also builds each crate from its package alone. The stored lock files of the other workspaces, which are
//! built nightly, must fit their manifests.

use cargo_metadata::camino::Utf8Path;
use cargo_metadata::{Metadata, Package};

use crate::process::{IGNORE_RUST_VERSION, cargo, cargo_path, run};
use crate::workspace::{Workspace, all, folder, no_faults, published};

/// Files that a package must contain, the licences identical to those of the workspace.
const NEEDED: [&str; 3] = ["LICENSE-MIT", "LICENSE-APACHE", "README.md"];

/// Files that a package may contain at its top level as well, apart from its sources.
const TOP_LEVEL: &str =
    ".cargo_vcs_info.json CHANGELOG.md Cargo.lock Cargo.toml Cargo.toml.orig build.rs";

/// Checks all published packages, and the lock files.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let mut faults = Vec::new();
    for package in published(metadata) {
        for fault in check_package(&metadata.workspace_root, package)? {
            faults.push(format!("{} {fault}", package.name));
        }
    }
    for Workspace { manifest, .. } in all(metadata)? {
        let lock = metadata
            .workspace_root
            .join(&manifest)
            .with_file_name("Cargo.lock");
        let update = format!("update --workspace --manifest-path {manifest}");
        if lock.exists() && cargo(&format!("{update} --quiet --locked")).is_err() {
            faults.push(format!("`cargo {update}` changes its lock file"));
        }
    }
    no_faults(&faults, "")
}

/// What is wrong with a package.
fn check_package(root: &Utf8Path, package: &Package) -> Result<Vec<String>, String> {
    let mut faults = Vec::new();
    for (field, is_there) in [
        ("description", package.description.is_some()),
        ("license", package.license.is_some()),
        ("readme", package.readme.is_some()),
        ("rust-version", package.rust_version.is_some()),
        ("keywords", !package.keywords.is_empty()),
        ("categories", !package.categories.is_empty()),
    ] {
        faults.extend((!is_there).then(|| format!("has no {field}")));
    }
    let list = format!("package --list --quiet --allow-dirty -p {}", package.name);
    let shipped = run(&cargo_path(), &list)?;
    for needed in NEEDED {
        let is_there = shipped.lines().any(|file| file == needed);
        faults.extend((!is_there).then(|| format!("would ship without {needed}")));
    }
    for licence in &NEEDED[..2] {
        let [own, due] = [folder(package), root].map(|it| std::fs::read(it.join(licence)).ok());
        faults.extend((own != due).then(|| format!("has another {licence} than the workspace")));
    }
    for file in shipped.lines() {
        let is_known = NEEDED.contains(&file) || TOP_LEVEL.split(' ').any(|known| known == file);
        let is_due = is_known || is_source(file);
        faults.extend((!is_due).then(|| format!("would ship {file}")));
    }
    Ok(faults)
}

/// True for a source file, and for a list that a test reads.
fn is_source(file: &str) -> bool {
    let ends = |ends: &[&str]| ends.iter().any(|end| file.ends_with(end));
    file.contains("src/") && ends(&[".rs"])
        || file.starts_with("src/") && ends(&[".wgsl", ".md", ".svg"])
        || file.starts_with("tests/") && ends(&[".rs", ".txt"])
}

/// Builds the packages from their archives alone, with all features, as a workspace outside of this one. It uses the
/// versions that are locked here, so that the dependencies need no other build.
pub(crate) fn build(metadata: &Metadata) -> Result<(), String> {
    let target = &metadata.target_directory;
    let folder = target.join("xtask-packages");
    let failed = |error: std::io::Error| format!("{folder}: {error}");
    // An interrupted run may have left packages that no longer exist.
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(failed)?;
    }
    let mut line = format!("package --quiet --allow-dirty --no-verify --target-dir {folder}");
    let mut manifest =
        "[workspace]\nresolver = \"3\"\nmembers = [\"*-*\"]\n[patch.crates-io]\n".to_owned();
    for Package { name, version, .. } in published(metadata) {
        line += &format!(" -p {name}");
        manifest += &format!("{name} = {{ path = \"{name}-{version}\" }}\n");
    }
    cargo(&line)?;
    for Package { name, version, .. } in published(metadata) {
        // -m: an archive has one date for all its files, by which cargo would take changed sources for built ones.
        let archive = format!("{folder}/package/{name}-{version}.crate");
        run("tar", &format!("-xzmf {archive} -C {folder}"))?;
    }
    std::fs::write(folder.join("Cargo.toml"), manifest).map_err(failed)?;
    std::fs::copy("Cargo.lock", folder.join("Cargo.lock")).map_err(failed)?;
    let check = format!("check --quiet --workspace --all-features {IGNORE_RUST_VERSION}");
    let check = format!("{check} --manifest-path {folder}/Cargo.toml --target-dir {target}");
    cargo(&check).and(std::fs::remove_dir_all(&folder).map_err(failed))
}
