//! Faults in parts of a file that are never read do not refuse the file.

use std::io;

use clamber_gltf::{ImportWarning, LoadOptions, Model, load_slice_with};
use serde_json::{Value, json};

use crate::builder::File;

/// Loads the square after a change of its document, and checks that it still is the square.
fn changed(what: &str, change: impl FnOnce(&mut Value)) -> Model {
    let mut file = File::square();
    change(&mut file.json);
    let model = file.load();
    assert!(model.is_ok(), "{what}: {model:?}");
    let model = model.unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.rig.clips.len()),
        (2, 1),
        "{what}"
    );
    model
}

#[test]
fn textures_in_any_format_and_images_that_cannot_be_read() {
    let pbr = json!({"baseColorTexture": {"index": 0}});
    let textured = |json: &mut Value, texture: Value, image: Value, required: &[&str]| {
        json["textures"] = json!([texture]);
        json["images"] = json!([image]);
        json["materials"][0]["pbrMetallicRoughness"] = pbr.clone();
        json["extensionsUsed"] = json!(required);
        json["extensionsRequired"] = json!(required);
    };
    let warned = [ImportWarning::Textures { materials: 1 }];
    for name in [
        "KHR_texture_basisu",
        "EXT_texture_webp",
        "EXT_texture_avif",
        "MSFT_texture_dds",
    ] {
        let texture = json!({"extensions": {name: {"source": 0}}});
        let image = json!({"uri": "no/such/image"});
        for required in [&[name][..], &[]] {
            let model = changed(name, |json| {
                textured(json, texture.clone(), image.clone(), required);
            });
            assert_eq!(model.report.warnings, warned, "{name}");
        }
    }
    // First a texture as Blockbench writes it, then some that are plainly wrong.
    for (texture, image) in [
        (json!({"name": "skin.png"}), json!({"uri": "data:,"})),
        (json!({"source": 7, "sampler": 7}), json!({})),
        (
            json!({"source": -1}),
            json!({"bufferView": 99, "mimeType": 3}),
        ),
        (json!(null), json!([])),
    ] {
        let model = changed("a texture", |json| textured(json, texture, image, &[]));
        assert_eq!(model.report.warnings, warned);
    }
}

#[test]
fn faults_in_what_is_not_loaded() {
    changed("cameras and samplers", |json| {
        json["cameras"] = json!([{"type": "fisheye"}]);
        json["samplers"] = json!([{"magFilter": 1}]);
        json["nodes"][0]["camera"] = json!(3);
        json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "moon"}]}});
    });
    changed("a mesh that nothing shows", |json| {
        let meshes = json["meshes"].as_array_mut().unwrap();
        meshes.push(json!({"primitives": [{"attributes": {"POSITION": 999}, "mode": 42}]}));
        meshes.push(json!({}));
    });
    changed(
        "an accessor, a view and a buffer that nothing names",
        |json| {
            json["buffers"] =
                json!([{"byteLength": 300}, {"byteLength": 5, "uri": "../../up"}, {}]);
            let views = json["bufferViews"].as_array_mut().unwrap();
            views.push(json!({"buffer": 1, "byteLength": 5_000, "byteStride": 1}));
            let view = views.len() - 1;
            let accessors = json["accessors"].as_array_mut().unwrap();
            accessors
                .push(json!({"bufferView": view, "componentType": 7, "count": 0, "type": "VEC9"}));
            let accessor = accessors.len() - 1;
            // Tangents are not read, either.
            json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(accessor);
        },
    );
    changed("whole numbers with a fraction", |json| {
        let count = &mut json["accessors"][0]["count"];
        *count = json!(count.as_u64().unwrap() as f64);
        json["nodes"][3]["mesh"] = json!(0.0);
    });
    // Messages have the line numbers of the text.
    let mut file = File::square();
    file.json["nodes"][0]["translation"] = json!("none");
    file.assert_refused("invalid type");
    file.assert_refused("line 1 column");
}

#[test]
fn a_byte_order_mark_is_no_fault() {
    let mut file = File::square();
    file.json["buffers"] = json!([{"byteLength": file.bytes.len(), "uri": "a.bin"}]);
    let marked = format!("\u{feff}{}", file.json);
    let model = load_slice_with(marked.as_bytes(), &LoadOptions::default(), |_| {
        Ok::<_, io::Error>(file.bytes.clone())
    });
    assert_eq!(model.unwrap().rig.collider.triangles().len(), 2);
}

#[test]
fn instances_of_a_mesh_are_told() {
    let mut file = File::square();
    file.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    let many = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}});
    file.json["nodes"][3]["extensions"] = many;
    let model = file.load().unwrap();
    assert_eq!(
        model.report.warnings,
        [ImportWarning::Instances { nodes: 1 }]
    );
    // If the extension is required, the file is refused.
    file.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    file.assert_refused("extensionsRequired");
}
