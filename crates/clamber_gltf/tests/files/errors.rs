//! Messages of errors.

use std::error::Error;

use clamber_gltf::{GltfErrorKind, LoadOptions, load, load_slice};
use serde_json::json;

use crate::builder::File;

/// The text of an error and of all its sources, as reporters print them.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(source) = next {
        text = format!("{text}: {source}");
        next = source.source();
    }
    text
}

fn said(bytes: &[u8]) -> String {
    let error = load_slice(bytes, &LoadOptions::default()).unwrap_err();
    chain(&error)
}

#[test]
fn other_formats_and_files_cut_short_have_different_errors() {
    for (bytes, text) in [
        (&b""[..], "the file is empty"),
        (b"hello", "neither GLB nor glTF"),
        (b"\x89PNG\r\n", "neither GLB nor glTF"),
        (b"  [1]", "neither GLB nor glTF"),
        (b"gl", "ends after 2 of 12 bytes"),
        (b"glTF\x02\0\0\0", "ends after 8 of 12 bytes"),
    ] {
        assert_eq!(said(bytes), text, "{bytes:?}");
    }
    let glb = File::square().glb();
    for cut in 12..glb.len() {
        let text = format!("ends after {cut} of {} bytes", glb.len());
        assert_eq!(said(&glb[..cut]), text);
    }
    let text = said(br#"  {"scenes": 3"#);
    assert!(text.starts_with("not a valid glTF 2.0 file: "), "{text}");
    let other = said(br#"{"price": 3}"#);
    assert!(other.contains("`asset`"), "{other}");
}

/// True if the chain of an error contains its cause exactly once.
fn tells_once(error: &dyn Error, cause: &str) -> bool {
    chain(error).matches(cause).count() == 1
}

#[test]
fn each_cause_is_told_once() {
    let missing = load("no/such/file.glb").unwrap_err();
    let GltfErrorKind::Read { error, .. } = &missing.kind else {
        panic!("{missing}");
    };
    assert!(tells_once(&missing, &error.to_string()), "{missing}");

    let mut file = File::square();
    file.json["nodes"][1]["rotation"] = json!([0, 0, 0, 0]);
    let kind = file.load().unwrap_err();
    let GltfErrorKind::Skeleton { error, .. } = &kind else {
        panic!("{kind}");
    };
    assert!(tells_once(&kind, &error.to_string()), "{kind}");

    let mut file = File::square();
    let flat = file.positions(&[[0.0; 3]; 4]);
    file.attributes()["POSITION"] = json!(flat);
    let kind = file.load().unwrap_err();
    let GltfErrorKind::Collider { error, .. } = &kind else {
        panic!("{kind}");
    };
    assert!(tells_once(&kind, &error.to_string()), "{kind}");
}
