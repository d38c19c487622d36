//! The bytes behind a file's buffers: the GLB's own chunk, data URIs, files beside it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use base64::Engine;
use gltf::Document;
use gltf::buffer::Source;

use crate::GltfErrorKind;

/// All buffers, each at least as long as it claims. `base` is the folder that relative URIs start
/// from; without one they are refused.
pub(crate) fn load(
    document: &Document,
    mut blob: Option<Vec<u8>>,
    base: Option<&Path>,
) -> Result<Vec<Vec<u8>>, GltfErrorKind> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let object = format!("buffer {}", buffer.index());
        let bytes = match buffer.source() {
            Source::Bin => blob.take().ok_or_else(|| {
                GltfErrorKind::invalid(&object, "has no URI, and the file no chunk")
            })?,
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    decode_data_uri(data).map_err(|e| GltfErrorKind::invalid(&object, e))?
                }
                None => read_beside(base, uri, buffer.length(), &object)?,
            },
        };
        if bytes.len() < buffer.length() {
            let reason = format!(
                "claims {} bytes, but holds {}",
                buffer.length(),
                bytes.len()
            );
            return Err(GltfErrorKind::invalid(object, reason));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
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

/// No more of a file beside the document than the buffer claims. Only plain files by relative paths:
/// a document from elsewhere must not name devices or files of the system.
fn read_beside(
    base: Option<&Path>,
    uri: &str,
    length: usize,
    object: &str,
) -> Result<Vec<u8>, GltfErrorKind> {
    let base = base.ok_or_else(|| {
        let reason = format!("its data is in the file {uri:?}: load from a path, not from bytes");
        GltfErrorKind::invalid(object, reason)
    })?;
    let name = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|e| GltfErrorKind::invalid(object, format!("its URI {uri:?} is no UTF-8: {e}")))?;
    let relative = Path::new(name.as_ref());
    if relative.has_root() || relative.is_absolute() || name.contains(':') {
        let reason = format!("its URI {uri:?} is not relative to the document");
        return Err(GltfErrorKind::invalid(object, reason));
    }
    let path = base.join(relative);
    read_plain_file(&path, length as u64).map_err(|source| GltfErrorKind::Read { path, source })
}

fn read_plain_file(path: &Path, length: u64) -> io::Result<Vec<u8>> {
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
