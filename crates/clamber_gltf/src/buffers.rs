//! The bytes behind a file's buffers: the GLB's own chunk, data URIs, files beside it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use gltf::Document;
use gltf::buffer::Source;

use crate::GltfErrorKind;

/// The bytes of every buffer; a file that several buffers name is held once.
pub(crate) struct Buffers {
    held: Vec<Vec<u8>>,
    /// Where in `held` each buffer is.
    of_buffer: Vec<usize>,
}

impl Buffers {
    /// The bytes of a buffer, at least as many as it claims.
    pub(crate) fn get(&self, buffer: usize) -> Option<&[u8]> {
        let bytes = self.held.get(*self.of_buffer.get(buffer)?)?;
        Some(bytes.as_slice())
    }

    /// How many bytes all buffers hold.
    pub(crate) fn held(&self) -> usize {
        let lengths = self.held.iter().map(Vec::len);
        lengths.fold(0, usize::saturating_add)
    }

    /// Reads all buffers. `base` is the folder that relative URIs start from; without one they are
    /// refused.
    pub(crate) fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        base: Option<&Path>,
    ) -> Result<Self, GltfErrorKind> {
        let mut buffers = Self {
            held: Vec::new(),
            of_buffer: Vec::new(),
        };
        let mut files: BTreeMap<PathBuf, usize> = BTreeMap::new();
        for buffer in document.buffers() {
            let object = format!("buffer {}", buffer.index());
            let invalid = |reason: String| GltfErrorKind::invalid(&object, reason);
            let next = buffers.held.len();
            let place = match buffer.source() {
                Source::Bin => {
                    let bytes = blob.take();
                    let missing = || invalid("has no URI, and the file no chunk".into());
                    buffers.held.push(bytes.ok_or_else(missing)?);
                    next
                }
                Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => {
                        buffers.held.push(decode_data_uri(data).map_err(invalid)?);
                        next
                    }
                    None => {
                        let path = path_beside(base, uri).map_err(invalid)?;
                        let place = *files.entry(path.clone()).or_insert(next);
                        if place == next {
                            buffers.held.push(Vec::new());
                        }
                        let held = &mut buffers.held[place];
                        if held.len() < buffer.length() {
                            let folder = base.unwrap_or(Path::new(""));
                            let target = target_in(folder, &path, &object)?;
                            *held = read_plain(&target, buffer.length() as u64)
                                .map_err(|source| GltfErrorKind::Read { path, source })?;
                        }
                        place
                    }
                },
            };
            buffers.of_buffer.push(place);
            let (claimed, found) = (buffer.length(), buffers.held[place].len());
            if found < claimed {
                return Err(invalid(format!(
                    "claims {claimed} bytes, but holds {found}"
                )));
            }
        }
        Ok(buffers)
    }
}

/// Decodes what follows `data:`.
fn decode_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let (kind, payload) = data
        .split_once(',')
        .ok_or("its data URI has no comma between type and data")?;
    if kind.ends_with(";base64") {
        base64::engine::general_purpose::STANDARD
            .decode(payload)
            .map_err(|e| format!("its data URI is no base64: {e}"))
    } else {
        Ok(percent_encoding::percent_decode_str(payload).collect())
    }
}

/// Where a URI leads: only to relative paths that stay within the folder, since a document from
/// elsewhere must not name devices or files of the system.
fn path_beside(base: Option<&Path>, uri: &str) -> Result<PathBuf, String> {
    let base = base.ok_or_else(|| {
        format!("its data is in the file {uri:?}: load from a path, not from bytes")
    })?;
    let name = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|e| format!("its URI {uri:?} is no UTF-8: {e}"))?;
    let relative = Path::new(name.as_ref());
    let inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    if !relative.components().all(inside) || name.contains(':') {
        return Err(format!(
            "its URI {uri:?} does not lead to a file in the document's folder or below"
        ));
    }
    let parts = relative
        .components()
        .filter(|part| *part != Component::CurDir);
    Ok(parts.fold(base.to_owned(), |path, part| path.join(part)))
}

/// Which file a path in a folder really is, with all symbolic links resolved: one that leads out of the folder is
/// refused, as a path out of it is.
fn target_in(folder: &Path, path: &Path, object: &str) -> Result<PathBuf, GltfErrorKind> {
    let resolve = |path: &Path| {
        path.canonicalize().map_err(|source| GltfErrorKind::Read {
            path: path.to_owned(),
            source,
        })
    };
    // The folder of a path without folders is empty, which no system resolves.
    let is_empty = folder.as_os_str().is_empty();
    let folder = resolve(if is_empty { Path::new(".") } else { folder })?;
    let target = resolve(path)?;
    if target.starts_with(&folder) {
        return Ok(target);
    }
    Err(GltfErrorKind::OutsideFolder {
        object: object.to_owned(),
        file: path.to_owned(),
        target,
    })
}

/// No more of a file than is claimed; it has to be a plain one.
fn read_plain(path: &Path, length: u64) -> io::Result<Vec<u8>> {
    // Before opening: to open a pipe would wait for its other end.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "not a plain file",
        ));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_in_the_current_folder_has_its_files_there() {
        // As `load("creature.gltf")` asks; tests run in the package's folder.
        let found = target_in(Path::new(""), Path::new("Cargo.toml"), "buffer 0");
        let wanted = std::env::current_dir().and_then(|folder| folder.canonicalize());
        assert_eq!(
            found.ok(),
            wanted.ok().map(|folder| folder.join("Cargo.toml"))
        );
    }
}
