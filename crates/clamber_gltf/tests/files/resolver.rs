//! Buffers from a resolver.

use std::io;

use clamber_gltf::{GltfErrorKind, LoadOptions, load_slice_with};
use serde_json::json;

use crate::builder::{File, remove};

/// A document whose buffers are at these URIs. The last one has the data.
fn document(file: &File, uris: &[(&str, usize)]) -> Vec<u8> {
    let mut json = file.json.clone();
    let buffers = uris.iter();
    let buffers = buffers.map(|(uri, length)| json!({"byteLength": length, "uri": uri}));
    json["buffers"] = buffers.collect();
    for view in json["bufferViews"].as_array_mut().unwrap() {
        view["buffer"] = json!(uris.len() - 1);
    }
    json.to_string().into_bytes()
}

#[test]
fn the_resolver_is_called_once_per_file_with_the_decoded_path() {
    let file = File::square();
    let all = file.bytes.len();
    let uris = [
        ("./a%20b//data.bin", 4),
        ("other.bin", 2),
        ("data:,%01%02", 2),
        ("a%20b/./data.bin", all),
    ];
    let asked = |document: &[u8]| {
        let mut asked = Vec::new();
        let model = load_slice_with(document, &LoadOptions::default(), |path| {
            asked.push(path.to_owned());
            Ok(match path {
                "a b/data.bin" => file.bytes.clone(),
                _ => vec![0; 100],
            })
        });
        assert_eq!(model.unwrap().rig.collider.positions().len(), 4);
        asked
    };
    // A buffer that is not read is not asked for: its file may be missing, and its URI may be any.
    let mut document = document(&file, &uris);
    assert_eq!(asked(&document), ["a b/data.bin"]);
    let text = String::from_utf8(document).unwrap();
    document = text
        .replace("other.bin", "https://example.org/no.bin")
        .into_bytes();
    assert_eq!(asked(&document), ["a b/data.bin"]);
    // An animation has its keys in buffers 0 and 1, and moves a node that is no joint.
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let push = |json: &mut serde_json::Value, list: &str, object| {
        let list = json[list].as_array_mut().unwrap();
        list.push(object);
        list.len() - 1
    };
    let node = push(&mut json, "nodes", json!({}));
    let [times, values] = [0, 1].map(|buffer| {
        let view = push(
            &mut json,
            "bufferViews",
            json!({"buffer": buffer, "byteLength": 2}),
        );
        let accessor =
            json!({"bufferView": view, "componentType": 5121, "count": 1, "type": "SCALAR"});
        push(&mut json, "accessors", accessor)
    });
    let animation = json!({
        "channels": [{"sampler": 0, "target": {"node": node, "path": "rotation"}}],
        "samplers": [{"input": times, "output": values}]
    });
    push(&mut json, "animations", animation);
    assert_eq!(
        asked(json.to_string().as_bytes()),
        ["a b/data.bin", "other.bin"]
    );
}

#[test]
fn files_that_are_short_or_missing_are_errors() {
    let file = File::square();
    let all = file.bytes.len();
    let document = document(&file, &[("data.bin", all)]);
    let options = LoadOptions::default();
    let short = load_slice_with(&document, &options, |_| Ok(file.bytes[1..].to_vec()));
    let text = format!("buffer 0: claims {all} bytes, but holds {}", all - 1);
    assert_eq!(short.unwrap_err().to_string(), text);
    let missing = load_slice_with(&document, &options, |_| {
        Err(io::Error::new(
            io::ErrorKind::NotFound,
            "not in the archive",
        ))
    });
    let error = missing.unwrap_err();
    assert!(matches!(error.kind, GltfErrorKind::Read { .. }), "{error}");
    assert_eq!(
        error.to_string(),
        "cannot read data.bin: not in the archive"
    );
}

#[test]
fn paths_out_of_the_folder_are_refused_before_the_resolver_is_called() {
    let file = File::square();
    for uri in [
        "/data.bin",
        "../data.bin",
        "a/%2e%2e/../data.bin",
        "file:data.bin",
        ".",
    ] {
        let document = document(&file, &[("fine.bin", 1), (uri, file.bytes.len())]);
        let refused = load_slice_with(&document, &LoadOptions::default(), |path| {
            panic!("{uri}: asked for {path}")
        });
        let error = refused.unwrap_err();
        let expected = matches!(error.kind, GltfErrorKind::Invalid { .. });
        assert!(expected, "{uri}: {error}");
    }
}

#[test]
fn bytes_beyond_the_buffers_do_not_raise_the_limit_of_memory() {
    let mut file = File::square();
    let vertices = 20_000;
    let zeros = json!({"componentType": 5126, "count": vertices, "type": "VEC3"});
    let zeros = file.push("accessors", zeros);
    file.json["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": zeros}}]);
    file.json["nodes"][3] = json!({"mesh": 0});
    remove(&mut file.json, "skins");
    let document = document(&file, &[("data.bin", file.bytes.len())]);
    let loaded = load_slice_with(&document, &LoadOptions::default(), |_| {
        let mut bytes = file.bytes.clone();
        bytes.resize(10 << 20, 0);
        Ok(bytes)
    });
    let error = loaded.unwrap_err().to_string();
    assert!(error.contains("more memory"), "{error}");
}
