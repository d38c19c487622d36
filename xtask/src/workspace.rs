//! Reads the repository: its workspaces, packages and files.

use std::collections::BTreeSet;

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};
use cargo_metadata::{Metadata, MetadataCommand, Package};

/// A workspace of the repository.
#[derive(Clone)]
pub(crate) struct Workspace {
    /// The workspace's manifest, from the root of the repository.
    pub(crate) manifest: Utf8PathBuf,
    pub(crate) metadata: Metadata,
}

/// The main workspace, from any folder in it: inside a package, cargo would take that package for the default member.
pub(crate) fn main() -> Result<Metadata, String> {
    let failed = |error| format!("cargo metadata failed: {error}");
    let here = MetadataCommand::new().no_deps().exec().map_err(failed)?;
    let manifest = here.workspace_root.join("Cargo.toml");
    let main = MetadataCommand::new().manifest_path(manifest).exec();
    main.map_err(failed)
}

/// The main workspace first; then each workspace of a manifest outside of it.
pub(crate) fn all(main: &Metadata) -> Result<Vec<Workspace>, String> {
    let (manifest, metadata) = ("Cargo.toml".into(), main.clone());
    let mut all = vec![Workspace { manifest, metadata }];
    for manifest in files(&main.workspace_root)? {
        let path = main.workspace_root.join(&manifest);
        let mut known = all.iter().flat_map(|it| it.metadata.workspace_packages());
        if manifest.file_name() == Some("Cargo.toml") && !known.any(|it| it.manifest_path == path) {
            // Without dependencies: some of these workspaces have no lock file.
            let read = MetadataCommand::new().manifest_path(path).no_deps().exec();
            let metadata = read.map_err(|error| format!("{manifest}: {error}"))?;
            all.push(Workspace { manifest, metadata });
        }
    }
    Ok(all)
}

/// The packages that users can depend on.
pub(crate) fn published(metadata: &Metadata) -> Vec<&Package> {
    let mut packages = metadata.workspace_packages();
    packages.retain(|package| package.publish.as_ref().is_none_or(|to| !to.is_empty()));
    packages
}

/// The folder of a package.
pub(crate) fn folder(package: &Package) -> &Utf8Path {
    package
        .manifest_path
        .parent()
        .unwrap_or(&package.manifest_path)
}

/// All files, sorted, as paths from a folder. Folders called `target` and hidden folders are left out.
pub(crate) fn files(root: &Utf8Path) -> Result<Vec<Utf8PathBuf>, String> {
    let (mut files, mut folders) = (Vec::new(), vec![root.to_owned()]);
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{folder}: {error}");
        for entry in folder.read_dir_utf8().map_err(failed)? {
            let path = entry.map_err(failed)?.into_path();
            let name = path.file_name().unwrap_or_default();
            if !path.is_dir() {
                files.push(path.strip_prefix(root).unwrap_or(&path).to_owned());
            } else if name != "target" && !name.starts_with('.') {
                folders.push(path);
            }
        }
    }
    files.sort();
    Ok(files)
}

/// The text of a file, with Unix line endings.
pub(crate) fn read(file: &Utf8Path) -> Result<String, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    Ok(text.replace("\r\n", "\n"))
}

/// The lines that only one of two lists has: `-` for the first list, `+` for the second one.
pub(crate) fn differences(first: &str, second: &str) -> Vec<String> {
    let [first, second] = [first, second].map(|text| text.lines().collect::<BTreeSet<_>>());
    let gone = first.difference(&second).map(|line| format!("- {line}"));
    let new = second.difference(&first).map(|line| format!("+ {line}"));
    gone.chain(new).collect()
}

/// Prints faults. An error with their number and a hint, if there are any.
pub(crate) fn no_faults(faults: &[String], hint: &str) -> Result<(), String> {
    faults.iter().for_each(|fault| eprintln!("   {fault}"));
    match faults.len() {
        0 => Ok(()),
        count => Err(format!("{count} faults, see above{hint}")),
    }
}
