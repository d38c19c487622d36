//! Loads the bytes of a file's buffers: from the GLB's chunk, data URIs, files beside the document, or a resolver.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use gltf::Document;
use gltf::buffer::Source;

use crate::{GltfErrorKind, uri};

/// The bytes of every buffer that is read. A file that several buffers name is held once.
pub(crate) struct Buffers {
    held: Vec<Vec<u8>>,
    /// The index of each buffer in `held`; `None` for a buffer that is not read.
    of_buffer: Vec<Option<usize>>,
}

impl Buffers {
    /// The bytes of a buffer, at least as many as it claims; `None` for a buffer that is not read, or an index out of
    /// range.
    pub(crate) fn get(&self, buffer: usize) -> Option<&[u8]> {
        let bytes = self.held.get((*self.of_buffer.get(buffer)?)?)?;
        Some(bytes.as_slice())
    }

    /// Number of bytes that all buffers hold.
    pub(crate) fn held(&self) -> usize {
        let lengths = self.held.iter().map(Vec::len);
        lengths.fold(0, usize::saturating_add)
    }

    /// Reads the buffers that `read` marks, each file once.
    pub(crate) fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        read: &[bool],
        mut files: Files<'_>,
    ) -> Result<Self, GltfErrorKind> {
        let mut buffers = Self {
            held: Vec::new(),
            of_buffer: Vec::new(),
        };
        let claims = claims(document)?;
        let mut places: BTreeMap<&str, usize> = BTreeMap::new();
        for (buffer, path) in document.buffers().zip(&claims.path_of_buffer) {
            if !read.get(buffer.index()).is_some_and(|read| *read) {
                buffers.of_buffer.push(None);
                continue;
            }
            let object = format!("buffer {}", buffer.index());
            let invalid = |reason: String| GltfErrorKind::invalid(&object, reason);
            let known = path.as_ref().and_then(|path| places.get(path.as_str()));
            let place = match known {
                Some(place) => *place,
                None => {
                    let bytes = match (buffer.source(), path) {
                        (Source::Bin, _) => {
                            let missing = || invalid("has no URI, and there is no chunk".into());
                            blob.take().ok_or_else(missing)?
                        }
                        (Source::Uri(_), Some(path)) => {
                            places.insert(path, buffers.held.len());
                            let length = claims.length_of_file.get(path.as_str());
                            files.read(path, length.copied().unwrap_or(0), &object)?
                        }
                        (Source::Uri(uri), None) => {
                            let data = uri.strip_prefix(DATA).unwrap_or(uri);
                            uri::decode_data(data).map_err(invalid)?
                        }
                    };
                    buffers.held.push(bytes);
                    buffers.held.len() - 1
                }
            };
            buffers.of_buffer.push(Some(place));
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

/// The prefix of a URI that contains the data.
const DATA: &str = "data:";

/// The files that the buffers of a document name.
#[derive(Default)]
struct Claims {
    /// `None` for a buffer inside the document.
    path_of_buffer: Vec<Option<String>>,
    /// For each file, the largest length that a buffer claims of it, bytes.
    length_of_file: BTreeMap<String, usize>,
}

fn claims(document: &Document) -> Result<Claims, GltfErrorKind> {
    let mut claims = Claims::default();
    for buffer in document.buffers() {
        let path = match buffer.source() {
            Source::Uri(uri) if !uri.starts_with(DATA) => {
                let object = format!("buffer {}", buffer.index());
                let path = uri::relative_path(uri);
                let path = path.map_err(|reason| GltfErrorKind::invalid(object, reason))?;
                let length = claims.length_of_file.entry(path.clone()).or_default();
                *length = buffer.length().max(*length);
                Some(path)
            }
            _ => None,
        };
        claims.path_of_buffer.push(path);
    }
    Ok(claims)
}

/// A caller's function that gives the contents of a file beside the document.
pub(crate) type Resolve<'a> = dyn FnMut(&str) -> io::Result<Vec<u8>> + 'a;

/// The source of the files beside a document.
pub(crate) enum Files<'a> {
    /// No files: a buffer in another file is an error.
    None,
    /// This folder and those below.
    Folder(&'a Path),
    /// A function of the caller.
    Resolver(&'a mut Resolve<'a>),
}

impl Files<'_> {
    /// Reads the first `length` bytes of a file, or all bytes if it is shorter.
    fn read(&mut self, path: &str, length: usize, object: &str) -> Result<Vec<u8>, GltfErrorKind> {
        match self {
            Self::None => Err(GltfErrorKind::invalid(
                object,
                format!("its data is in the file {path:?}: load from a path, or with a resolver"),
            )),
            Self::Folder(folder) => {
                let path = path
                    .split('/')
                    .fold(folder.to_owned(), |at, part| at.join(part));
                let target = target_in(folder, &path, object)?;
                read_plain(&target, length as u64)
                    .map_err(|error| GltfErrorKind::Read { path, error })
            }
            Self::Resolver(resolve) => {
                let mut bytes = resolve(path).map_err(|error| GltfErrorKind::Read {
                    path: PathBuf::from(path),
                    error,
                })?;
                // Bytes that no buffer claims must not raise the memory limit.
                bytes.truncate(length);
                Ok(bytes)
            }
        }
    }
}

/// Resolves all symbolic links of a path in a folder. A link that leads out of the folder is refused.
fn target_in(folder: &Path, path: &Path, object: &str) -> Result<PathBuf, GltfErrorKind> {
    let resolve = |path: &Path| {
        path.canonicalize().map_err(|error| GltfErrorKind::Read {
            path: path.to_owned(),
            error,
        })
    };
    // A path without folders has an empty folder, which no system resolves.
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

/// Reads the first `length` bytes of a file, which must be a regular file.
fn read_plain(path: &Path, length: u64) -> io::Result<Vec<u8>> {
    // Checked before opening, since opening a pipe waits for its other end.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "not a regular file",
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
        // The folder of `load("creature.gltf")` is empty. Tests run in the package's folder.
        let found = target_in(Path::new(""), Path::new("Cargo.toml"), "buffer 0");
        let wanted = std::env::current_dir().and_then(|folder| folder.canonicalize());
        assert_eq!(
            found.ok(),
            wanted.ok().map(|folder| folder.join("Cargo.toml"))
        );
    }
}
