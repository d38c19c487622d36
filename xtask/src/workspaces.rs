//! Finds the workspaces of the repository: the main one, and those beside it.

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};
use cargo_metadata::{Metadata, MetadataCommand, Package};

use crate::files::files;
use crate::test_run::MAIN;

#[derive(Clone)]
pub(crate) struct Workspace {
    /// The workspace's manifest, from the root of the repository.
    pub(crate) manifest: String,
    pub(crate) metadata: Metadata,
}

/// The main workspace, from any folder in it: inside a package, cargo would take that package for the default member.
pub(crate) fn main() -> Result<Metadata, String> {
    let failed = |error| format!("cargo metadata failed: {error}");
    let here = MetadataCommand::new().no_deps().exec().map_err(failed)?;
    let manifest = here.workspace_root.join(MAIN);
    let main = MetadataCommand::new().manifest_path(manifest).exec();
    main.map_err(failed)
}

/// The main workspace first; then each workspace of a manifest outside of it.
pub(crate) fn all(main: &Metadata) -> Result<Vec<Workspace>, String> {
    let root = &main.workspace_root;
    let mut all = vec![Workspace {
        manifest: MAIN.into(),
        metadata: main.clone(),
    }];
    for file in files(root)? {
        let manifest = root.join(&file);
        let is_known = |known: &Workspace| {
            let packages = known.metadata.workspace_packages();
            packages
                .iter()
                .any(|package| package.manifest_path == manifest)
        };
        if file.file_name() != Some("Cargo.toml") || all.iter().any(is_known) {
            continue;
        }
        // Without dependencies: some of these workspaces have no lock file.
        let metadata = MetadataCommand::new()
            .manifest_path(&manifest)
            .no_deps()
            .exec();
        let metadata = metadata.map_err(|error| format!("{file}: {error}"))?;
        let manifest = metadata.workspace_root.join("Cargo.toml");
        let manifest = manifest.strip_prefix(root).unwrap_or(&manifest).to_string();
        all.push(Workspace { manifest, metadata });
    }
    Ok(all)
}

/// The package that a file of the repository belongs to, which has the nearest manifest above the file.
pub(crate) fn owner<'a>(
    all: &'a [Workspace],
    root: &Utf8Path,
    file: &Utf8Path,
) -> Option<(&'a Workspace, &'a Package)> {
    let packages = all.iter().flat_map(|workspace| {
        let packages = workspace.metadata.workspace_packages().into_iter();
        packages.map(move |package| (workspace, package))
    });
    let file = root.join(file);
    packages
        .filter(|(_, package)| file.starts_with(folder(package)))
        .max_by_key(|(_, package)| folder(package).components().count())
}

/// The folder of a package.
pub(crate) fn folder(package: &Package) -> Utf8PathBuf {
    let folder = package.manifest_path.parent();
    folder.map(Utf8Path::to_owned).unwrap_or_default()
}
