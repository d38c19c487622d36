//! Buffers in data URIs, and in files beside the document.

use std::path::Path;

use clamber_gltf::{GltfErrorKind, LoadOptions, load, load_slice};

use crate::builder::File;

#[test]
fn buffers_come_from_data_uris_and_from_files_beside_the_document() {
    let file = File::square();
    let folder = std::env::temp_dir().join(format!("clamber-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("a b")).unwrap();
    std::fs::write(folder.join("a b/data.bin"), &file.bytes).unwrap();
    let document = folder.join("square.gltf");
    std::fs::write(&document, file.gltf("data:nothing")).unwrap();
    let error = load(&document).unwrap_err();
    assert_eq!(error.path.as_ref(), Some(&document));
    assert!(
        error
            .to_string()
            .starts_with(&document.display().to_string()),
        "{error}"
    );
    let load_with_uri = |uri: &str| {
        std::fs::write(&document, file.gltf(uri)).unwrap();
        load(&document).map_err(|error| error.kind)
    };
    assert!(load_with_uri("a%20b/data.bin").is_ok());
    assert!(load_with_uri("./a%20b/data.bin").is_ok());
    let encoded: String = file
        .bytes
        .iter()
        .map(|byte| format!("%{byte:02x}"))
        .collect();
    assert!(load_with_uri(&format!("data:application/octet-stream,{encoded}")).is_ok());

    assert!(matches!(
        load_with_uri("missing.bin"),
        Err(GltfErrorKind::Read { .. })
    ));
    assert!(
        matches!(load_with_uri("a%20b"), Err(GltfErrorKind::Read { .. })),
        "a folder"
    );
    for refused in [
        "/dev/zero",
        "../data.bin",
        "a%20b/../../data.bin",
        "file:///dev/zero",
        "data:;base64,&&&",
        "data:nothing",
    ] {
        let error = load_with_uri(refused).unwrap_err();
        assert!(
            matches!(error, GltfErrorKind::Invalid { .. }),
            "{refused}: {error}"
        );
    }
    // Two buffers in one file, the first one shorter.
    let mut twice: serde_json::Value =
        serde_json::from_slice(&file.gltf("a%20b/data.bin")).unwrap();
    let whole = twice["buffers"][0].clone();
    twice["buffers"] = serde_json::json!([{"byteLength": 4, "uri": "./a%20b/data.bin"}, whole]);
    for view in twice["bufferViews"].as_array_mut().unwrap() {
        view["buffer"] = serde_json::json!(1);
    }
    std::fs::write(&document, twice.to_string()).unwrap();
    load(&document).unwrap();
    std::fs::write(folder.join("short.bin"), b"short").unwrap();
    assert!(matches!(
        load_with_uri("short.bin"),
        Err(GltfErrorKind::Invalid { .. })
    ));
    let bytes = file.gltf("a%20b/data.bin");
    let error = load_slice(&bytes, &LoadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("load from a path"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(load(Path::new("no/such/file.glb")).is_err());
}
