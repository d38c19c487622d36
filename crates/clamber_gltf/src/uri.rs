//! Decodes the URIs of buffers: embedded data, or files in the document's folder or below.

use std::path::{Component, Path};

use base64::Engine;

/// Decodes a data URI, without its `data:`.
pub(crate) fn decode_data(data: &str) -> Result<Vec<u8>, String> {
    let (kind, payload) = data
        .split_once(',')
        .ok_or("its data URI has no comma between type and data")?;
    if kind.ends_with(";base64") {
        base64::engine::general_purpose::STANDARD
            .decode(payload)
            .map_err(|e| format!("its data URI is not base64: {e}"))
    } else {
        Ok(percent_encoding::percent_decode_str(payload).collect())
    }
}

/// The relative path that a URI names, decoded, with `/` between its parts and without `.` and `..`. Paths that are
/// absolute or leave the folder are refused: a document from elsewhere must not name devices or files of the system.
pub(crate) fn relative_path(uri: &str) -> Result<String, String> {
    let name = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|e| format!("its URI {uri:?} is not UTF-8: {e}"))?;
    let refused =
        || format!("its URI {uri:?} does not lead to a file in the document's folder or below");
    let mut parts = Vec::new();
    for part in Path::new(name.as_ref()).components() {
        match part {
            Component::Normal(part) => parts.push(part.to_str().ok_or_else(refused)?),
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop().ok_or_else(refused)?),
            _ => return Err(refused()),
        }
    }
    if parts.is_empty() || name.contains(':') {
        return Err(refused());
    }
    Ok(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_decoded_and_normalised() {
        for (uri, path) in [
            ("data.bin", "data.bin"),
            ("./a%20b//./data.bin", "a b/data.bin"),
            ("./a/../b%20c.bin", "b c.bin"),
            ("%C3%A9.bin?x", "\u{e9}.bin?x"),
        ] {
            assert_eq!(relative_path(uri).as_deref(), Ok(path), "{uri}");
        }
        for uri in [
            "",
            ".",
            "/a",
            "%2Fa",
            "a/..",
            "%2e%2e/a",
            "a/../../b",
            "c:a",
            "%FF",
        ] {
            assert!(relative_path(uri).is_err(), "{uri}");
        }
    }
}
