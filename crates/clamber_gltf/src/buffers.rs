//! The bytes behind a file's buffers: the GLB's own chunk, data URIs, files beside it.

use std::path::Path;

use base64::Engine;
use gltf::buffer::Source;

use crate::GltfError;

/// All buffers, each at least as long as it claims. `base` is the folder that relative URIs start
/// from; without one they are refused.
pub(crate) fn load(file: &mut gltf::Gltf, base: Option<&Path>) -> Result<Vec<Vec<u8>>, GltfError> {
    let mut blob = file.blob.take();
    let mut buffers = Vec::new();
    for buffer in file.buffers() {
        let object = format!("buffer {}", buffer.index());
        let bytes = match buffer.source() {
            Source::Bin => blob
                .take()
                .ok_or_else(|| GltfError::invalid(&object, "has no URI, and the file no chunk"))?,
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => decode_data_uri(data).map_err(|e| GltfError::invalid(&object, e))?,
                None => read_beside(base, uri, &object)?,
            },
        };
        if bytes.len() < buffer.length() {
            let reason = format!(
                "claims {} bytes, but holds {}",
                buffer.length(),
                bytes.len()
            );
            return Err(GltfError::invalid(object, reason));
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

fn read_beside(base: Option<&Path>, uri: &str, object: &str) -> Result<Vec<u8>, GltfError> {
    let base = base.ok_or_else(|| {
        let reason = format!("its data is in the file {uri:?}: load from a path, not from bytes");
        GltfError::invalid(object, reason)
    })?;
    let name = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|e| GltfError::invalid(object, format!("its URI {uri:?} is no UTF-8: {e}")))?;
    let path = base.join(name.as_ref());
    std::fs::read(&path).map_err(|source| GltfError::Read { path, source })
}
