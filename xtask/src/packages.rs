//! Checks each published crate as crates.io would get it: its metadata, its licences, and its list of files. The
//! nightly task also builds each crate from its package alone. The stored lock files of the other workspaces, which are
//! built nightly, must fit their manifests.

use cargo_metadata::camino::Utf8Path;
use cargo_metadata::{Metadata, Package};

use crate::features::published;
use crate::files::files;
use crate::run::{IGNORE_RUST_VERSION, cargo, cargo_output, program};
use crate::workspaces;

/// Licence texts that each package must carry, identical to the workspace's.
const LICENCES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

/// Files that a package may contain at its top level, apart from its sources.
const TOP_LEVEL: [&str; 9] = [
    ".cargo_vcs_info.json",
    "CHANGELOG.md",
    "Cargo.lock",
    "Cargo.toml",
    "Cargo.toml.orig",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "build.rs",
];

pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    let packages: Vec<&Package> = published(metadata).collect();
    for package in &packages {
        check_metadata(package)?;
        check_licences(metadata, package)?;
        check_files(package)?;
    }
    check_locks(metadata)
}

/// Checks that each stored lock file contains all dependencies of its workspace.
fn check_locks(metadata: &Metadata) -> Result<(), String> {
    let stored = files(&metadata.workspace_root)?;
    for workspace in workspaces::all(metadata)? {
        let lock = Utf8Path::new(&workspace.manifest).with_file_name("Cargo.lock");
        if !stored.contains(&lock) {
            continue;
        }
        let manifest = metadata.workspace_root.join(&workspace.manifest);
        let update = ["update", "--quiet", "--workspace", "--locked"];
        let locked = cargo(&[&update[..], &["--manifest-path", manifest.as_str()]].concat());
        locked.map_err(|error| {
            let manifest = &workspace.manifest;
            format!("{error}: `cargo update --workspace --manifest-path {manifest}` mends its lock")
        })?;
    }
    Ok(())
}

/// Builds each package from its archive alone.
pub(crate) fn build(metadata: &Metadata) -> Result<(), String> {
    let packages: Vec<&Package> = published(metadata).collect();
    let folder = metadata.target_directory.join("xtask-packages");
    // An interrupted run may have left packages that no longer exist.
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|error| format!("{folder}: {error}"))?;
    }
    let built = unpack(&packages, &folder).and_then(|()| check_build(&packages, &folder));
    let removed = std::fs::remove_dir_all(&folder).map_err(|error| format!("{folder}: {error}"));
    built.and(removed)
}

/// Creates the packages and unpacks them into one folder.
fn unpack(packages: &[&Package], folder: &Utf8Path) -> Result<(), String> {
    let mut arguments = vec!["package", "--quiet", "--allow-dirty", "--no-verify"];
    arguments.extend(["--target-dir", folder.as_str()]);
    for package in packages {
        arguments.extend(["-p", package.name.as_str()]);
    }
    cargo(&arguments)?;
    for package in packages {
        // -m: an archive has one date for all its files, by which cargo would take changed sources for built ones.
        let archive = format!("package/{}-{}.crate", package.name, package.version);
        program(
            "tar".into(),
            &[
                "-xzmf",
                folder.join(archive).as_str(),
                "-C",
                folder.as_str(),
            ],
        )?;
    }
    Ok(())
}

/// Checks that the packages build from each other, as a workspace outside of this one. It uses the versions that are
/// locked here, so that the dependencies need no other build. Another step builds each feature alone.
fn check_build(packages: &[&Package], folder: &Utf8Path) -> Result<(), String> {
    let mut manifest =
        "[workspace]\nresolver = \"3\"\nmembers = [\"*-*\"]\n[patch.crates-io]\n".to_owned();
    for package in packages {
        let (name, version) = (&package.name, &package.version);
        manifest += &format!("{name} = {{ path = \"{name}-{version}\" }}\n");
    }
    let path = folder.join("Cargo.toml");
    std::fs::write(&path, manifest).map_err(|error| format!("{path}: {error}"))?;
    std::fs::copy("Cargo.lock", folder.join("Cargo.lock"))
        .map_err(|error| format!("Cargo.lock: {error}"))?;
    let check = [
        "check",
        "--quiet",
        "--workspace",
        "--manifest-path",
        path.as_str(),
        IGNORE_RUST_VERSION,
    ];
    let target = folder.parent().map_or("target", Utf8Path::as_str);
    cargo(&[&check[..], &["--target-dir", target, "--all-features"]].concat())
}

fn check_metadata(package: &Package) -> Result<(), String> {
    let missing = [
        ("description", package.description.is_none()),
        ("license", package.license.is_none()),
        ("readme", package.readme.is_none()),
        ("rust-version", package.rust_version.is_none()),
        ("keywords", package.keywords.is_empty()),
        ("categories", package.categories.is_empty()),
    ];
    match missing.iter().find(|(_, missing)| *missing) {
        Some((field, _)) => Err(format!("{} has no {field}", package.name)),
        None => Ok(()),
    }
}

/// Checks that each package carries the workspace's licence texts.
fn check_licences(metadata: &Metadata, package: &Package) -> Result<(), String> {
    let folder = package
        .manifest_path
        .parent()
        .ok_or("a manifest without a folder")?;
    for licence in LICENCES {
        let read = |path: &cargo_metadata::camino::Utf8Path| {
            std::fs::read(path).map_err(|error| format!("{path}: {error}"))
        };
        if read(&folder.join(licence))? != read(&metadata.workspace_root.join(licence))? {
            return Err(format!("{folder}/{licence} differs from the workspace's"));
        }
    }
    Ok(())
}

fn check_files(package: &Package) -> Result<(), String> {
    let list = [
        "package",
        "--list",
        "--quiet",
        "--allow-dirty",
        "-p",
        &package.name,
    ];
    let files = cargo_output(&list)?;
    let source = |file: &str| {
        let code = file.ends_with(".rs") && (file.contains("src/") || file.starts_with("tests/"));
        let other = [".wgsl", ".md", ".svg"];
        // Lists that a test reads are beside the test.
        let list = file.starts_with("tests/") && file.ends_with(".txt");
        code || list || file.starts_with("src/") && other.iter().any(|end| file.ends_with(end))
    };
    for file in files.lines() {
        if !TOP_LEVEL.contains(&file) && !source(file) {
            return Err(format!("{} would ship {file}", package.name));
        }
    }
    for needed in ["LICENSE-MIT", "LICENSE-APACHE", "README.md"] {
        if !files.lines().any(|file| file == needed) {
            return Err(format!("{} would ship without {needed}", package.name));
        }
    }
    Ok(())
}
