//! Lists and reads the files of the repository.

use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

/// All files, sorted, as paths from the root of the repository. Folders called `target` and hidden folders are left
/// out.
pub(crate) fn files(root: &Utf8Path) -> Result<Vec<Utf8PathBuf>, String> {
    let mut files = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        let failed = |error: std::io::Error| format!("{folder}: {error}");
        for entry in folder.read_dir_utf8().map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let is_skipped = entry.file_name() == "target" || entry.file_name().starts_with('.');
            if entry.file_type().map_err(failed)?.is_dir() {
                if !is_skipped {
                    folders.push(entry.into_path());
                }
            } else {
                let path = entry.path();
                files.push(path.strip_prefix(root).unwrap_or(path).to_owned());
            }
        }
    }
    files.sort();
    Ok(files)
}

/// The text of a file, with Unix line endings.
pub(crate) fn read(root: &Utf8Path, file: &Utf8Path) -> Result<String, String> {
    let text = std::fs::read_to_string(root.join(file));
    let text = text.map_err(|error| format!("{file}: {error}"))?;
    Ok(text.replace("\r\n", "\n"))
}
