//! Small files made here: what they load as, and what becomes of them when they are broken.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::path::Path;

use clamber_gltf::{GltfError, LoadOptions, Rig, load, load_slice};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::SurfaceKind;
use clamber_surface::rig::{JointId, Playback};
use clamber_surface::surface::SkinnedSurface;
use serde_json::{Value, json};

/// A document under construction: JSON, and the bytes of its one buffer.
struct File {
    json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// A square of two triangles on two joints, the upper one turned by a clip; the joints hang
    /// under a plain node.
    fn square() -> Self {
        let mut file = Self {
            json: json!({
                "asset": {"version": "2.0"},
                "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [
                    {"name": "armature", "children": [1, 3], "scale": [2, 2, 2]},
                    {"name": "lower", "children": [2]},
                    {"name": "upper", "translation": [0, 1, 0]},
                    {"name": "body", "mesh": 0, "skin": 0}
                ],
                "materials": [{"extras": {"clamber": {"surface": "fur"}}}],
                "accessors": [], "bufferViews": []
            }),
            bytes: Vec::new(),
        };
        let square: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let positions = file.floats("VEC3", square.as_flattened());
        file.json["accessors"][positions]["min"] = json!([0, 0, 0]);
        file.json["accessors"][positions]["max"] = json!([1, 1, 0]);
        let joints = file.accessor("VEC4", 5121, 4, &[0, 1, 0, 0].repeat(4));
        let weights: Vec<f32> = [1.0, 1.0, 0.0, 0.0]
            .iter()
            .flat_map(|w| [*w, 1.0 - w, 0.0, 0.0])
            .collect();
        let weights = file.floats("VEC4", &weights);
        let indices = [0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes);
        let indices = file.accessor("SCALAR", 5123, 6, indices.as_flattened());
        let mut binds = [[0.0f32; 16]; 2];
        for bind in &mut binds {
            for k in 0..4 {
                bind[5 * k] = 1.0;
            }
        }
        binds[1][13] = -1.0;
        let binds = file.floats("MAT4", binds.as_flattened());
        let times = file.floats("SCALAR", &[0.0, 1.0]);
        let half = 0.5f32.sqrt();
        let turns = file.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
        file.json["meshes"] = json!([{"primitives": [{
            "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
            "indices": indices, "material": 0
        }]}]);
        file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": binds}]);
        file.json["animations"] = json!([{
            "name": "turn",
            "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}],
            "samplers": [{"input": times, "output": turns}]
        }]);
        file
    }

    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        self.accessor(kind, 5126, values.len() / width, &bytes)
    }

    /// Appends an accessor with a view of its own; gives its index.
    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        });
        self.bytes.extend_from_slice(bytes);
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(view);
        let accessor = json!({
            "bufferView": views.len() - 1, "componentType": component, "count": count, "type": kind
        });
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    /// As a GLB.
    fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json.is_object() && json.get("buffers").is_none() {
            json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        }
        glb_of(&serde_json::to_vec(&json).unwrap(), &self.bytes)
    }

    /// As a `.gltf` whose buffer is at a URI.
    fn gltf(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        serde_json::to_vec(&json).unwrap()
    }

    fn load(&self) -> Result<Rig, GltfError> {
        load_slice(&self.glb(), &LoadOptions::default())
    }
}

fn glb_of(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json, b' '), padded(bin, 0));
    let length = (12 + 8 + json.len() + 8 + bin.len()) as u32;
    let mut glb = b"glTF".to_vec();
    for word in [2, length, json.len() as u32] {
        glb.extend(word.to_le_bytes());
    }
    glb.extend(b"JSON");
    glb.extend(&json);
    glb.extend((bin.len() as u32).to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(&bin);
    glb
}

/// Poses a rig in the middle of every clip, as a user would; a rig that loads must not panic later.
fn use_rig(rig: &Rig) {
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    for clip in &rig.clips {
        let rest = rig.skeleton.rest_pose();
        if let Ok(pose) = clip.sample(&rest, clip.duration() * 0.5, Playback::Loop)
            && let Ok(palette) = rig.skeleton.palette(&pose)
        {
            let _ = surface.advance(&palette, Similarity::IDENTITY);
        }
    }
}

#[test]
fn the_square_loads_as_it_was_made() {
    let rig = File::square().load().unwrap();
    assert!(rig.report.warnings.is_empty(), "{:?}", rig.report.warnings);
    let names: Vec<_> = rig
        .skeleton
        .joints()
        .iter()
        .map(|j| j.name.as_str())
        .collect();
    assert_eq!(names, ["lower", "upper", "armature"]);
    assert_eq!(rig.skeleton.joints()[0].parent, Some(JointId(2)));
    assert_eq!(rig.collider.positions().len(), 4);
    assert!(
        rig.collider
            .tags()
            .iter()
            .all(|tag| tag.kind == SurfaceKind::Fur)
    );
    // Half way the upper edge has turned by 45 degrees about (0, 1), at twice the size.
    let clip = rig.clip("turn").unwrap();
    let pose = clip
        .sample(&rig.skeleton.rest_pose(), 0.5, Playback::Clamp)
        .unwrap();
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    surface
        .advance(&rig.skeleton.palette(&pose).unwrap(), Similarity::IDENTITY)
        .unwrap();
    let corner = surface.positions()[2];
    let diagonal = 2.0 * 0.5f32.sqrt();
    let expected = glam::Vec3::new(diagonal, 2.0 + diagonal, 0.0);
    assert!((corner - expected).length() < 1e-6, "{corner} {expected}");
}

#[test]
fn buffers_come_from_data_uris_and_from_files_beside_the_document() {
    let file = File::square();
    let folder = std::env::temp_dir().join(format!("clamber-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("a b")).unwrap();
    std::fs::write(folder.join("a b/data.bin"), &file.bytes).unwrap();
    let document = folder.join("square.gltf");
    let load_with_uri = |uri: &str| {
        std::fs::write(&document, file.gltf(uri)).unwrap();
        load(&document)
    };
    assert!(load_with_uri("a%20b/data.bin").is_ok());
    let encoded: String = file
        .bytes
        .iter()
        .map(|byte| format!("%{byte:02x}"))
        .collect();
    assert!(load_with_uri(&format!("data:application/octet-stream,{encoded}")).is_ok());

    assert!(matches!(
        load_with_uri("missing.bin"),
        Err(GltfError::Read { .. })
    ));
    assert!(
        matches!(load_with_uri("a%20b"), Err(GltfError::Read { .. })),
        "a folder"
    );
    for refused in [
        "/dev/zero",
        "file:///dev/zero",
        "data:;base64,&&&",
        "data:nothing",
    ] {
        let error = load_with_uri(refused).unwrap_err();
        assert!(
            matches!(error, GltfError::Invalid { .. }),
            "{refused}: {error}"
        );
    }
    std::fs::write(folder.join("short.bin"), b"short").unwrap();
    assert!(matches!(
        load_with_uri("short.bin"),
        Err(GltfError::Invalid { .. })
    ));
    let bytes = file.gltf("a%20b/data.bin");
    let error = load_slice(&bytes, &LoadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("load from a path"), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(load(Path::new("no/such/file.glb")).is_err());
}

#[test]
fn what_does_not_concern_a_collider_is_passed_over() {
    let mut file = File::square();
    file.json["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = file.json["extensionsUsed"].clone();
    let channels = file.json["animations"][0]["channels"]
        .as_array_mut()
        .unwrap();
    channels.push(json!({"sampler": 0, "target": {"path": "rotation"}}));
    channels.push(json!({"sampler": 0, "target": {"node": 1, "path": "pointer"}}));
    // Of a node outside the skeleton, and with values that do not fit.
    channels.push(json!({"sampler": 0, "target": {"node": 3, "path": "scale"}}));
    file.json["nodes"]
        .as_array_mut()
        .unwrap()
        .push(json!({"mesh": 0}));
    let rig = file.load().unwrap();
    assert_eq!(rig.clips[0].channels().len(), 1);
    assert_eq!(rig.report.warnings.len(), 4, "{:?}", rig.report.warnings);

    file.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(matches!(file.load(), Err(GltfError::Format(_))));
}

#[test]
fn the_larger_of_two_skins_is_taken_and_the_other_one_named() {
    let mut file = File::square();
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    nodes.push(json!({"mesh": 0, "skin": 1}));
    nodes.push(json!({"mesh": 0, "skin": 1}));
    file.json["skins"]
        .as_array_mut()
        .unwrap()
        .push(json!({"joints": [2, 1]}));
    let rig = file.load().unwrap();
    assert_eq!(rig.skeleton.joints()[0].name, "upper");
    assert_eq!(rig.collider.triangles().len(), 2, "one mesh, shown twice");
    assert_eq!(rig.report.warnings.len(), 1);
    let first = LoadOptions {
        skin: Some(0),
        ..LoadOptions::default()
    };
    let rig = load_slice(&file.glb(), &first).unwrap();
    assert_eq!(rig.skeleton.joints()[0].name, "lower");
}

#[test]
fn joints_and_bind_matrices_beyond_the_skin() {
    // A third bind matrix is legal to have, whatever it holds, and belongs to no one.
    let mut file = File::square();
    let mut binds = [f32::NAN; 48];
    for k in 0..8 {
        binds[4 * k..4 * k + 4].fill(0.0);
        binds[4 * k + k % 4] = 1.0;
    }
    let binds = file.floats("MAT4", &binds);
    file.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let rig = file.load().unwrap();
    assert_eq!(rig.skeleton.joints()[2].inverse_bind, Affine::IDENTITY);

    let mut file = File::square();
    file.json["skins"][0]["joints"] = json!([1]);
    let error = file.load().unwrap_err();
    assert!(
        error.to_string().contains("joint 1 of a skin of 1"),
        "{error}"
    );
    // Where it weighs nothing, it is padding.
    let all_on_joint_0 = file.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(4));
    let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = json!(all_on_joint_0);
    file.json["animations"] = json!([]);
    assert!(file.load().is_ok());
    file.json["skins"][0]["joints"] = json!([1, 2, 0]);
    let error = file.load().unwrap_err();
    assert!(
        error.to_string().contains("2 inverse bind matrices"),
        "{error}"
    );
}

#[test]
fn a_file_that_is_read_again_and_again_is_refused_before_memory_is() {
    let mut file = File::square();
    let vertices = 5_000;
    let many = vec![0.5f32; vertices * 3];
    let positions = file.floats("VEC3", &many);
    file.json["accessors"][positions]["min"] = json!([0.5, 0.5, 0.5]);
    file.json["accessors"][positions]["max"] = json!([0.5, 0.5, 0.5]);
    let joints = file.accessor("VEC4", 5121, vertices, &vec![0; vertices * 4]);
    let weights = file.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(vertices));
    let primitive = json!({"attributes": {
        "POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights
    }});
    let primitives = file.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.extend(vec![primitive; 2_000]);
    let error = file.load().unwrap_err();
    assert!(error.to_string().contains("more memory"), "{error}");

    // Sparse over nothing: a claim that no bytes back.
    let mut file = File::square();
    let accessor = file.json["accessors"][0].as_object_mut().unwrap();
    accessor.remove("bufferView");
    accessor.insert("count".into(), json!(1u64 << 40));
    accessor.insert(
        "sparse".into(),
        json!({
            "count": 1, "values": {"bufferView": 0},
            "indices": {"bufferView": 3, "componentType": 5123}
        }),
    );
    let error = file.load().unwrap_err();
    assert!(error.to_string().contains("more memory"), "{error}");
}

/// Every place in a JSON value, as a pointer.
fn pointers(value: &Value, at: String, all: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                pointers(item, format!("{at}/{k}"), all);
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                pointers(field, format!("{at}/{name}"), all);
            }
        }
        _ => {}
    }
    all.push(at);
}

#[test]
fn no_change_of_a_value_panics() {
    let file = File::square();
    let mut all = Vec::new();
    pointers(&file.json, String::new(), &mut all);
    let hostile = [
        json!(0),
        json!(1),
        json!(3),
        json!(-1),
        json!(999),
        json!(u32::MAX),
        json!(u64::MAX),
        json!(0.5),
        json!(1e308),
        json!(null),
        json!(true),
        json!(""),
        json!("VEC2"),
        json!([]),
        json!([0, 0, 0, 0]),
        json!({}),
        json!(5121),
        json!(5125),
    ];
    let (mut loaded, mut refused) = (0, 0);
    for pointer in &all {
        for value in &hostile {
            let mut json = file.json.clone();
            *json.pointer_mut(pointer).unwrap() = value.clone();
            let changed = File {
                json,
                bytes: file.bytes.clone(),
            };
            match changed.load() {
                Ok(rig) => {
                    use_rig(&rig);
                    loaded += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(
        loaded > 100 && refused > 500,
        "{loaded} loaded, {refused} refused"
    );
}

#[test]
fn no_flip_or_cut_of_bytes_panics() {
    let file = File::square();
    let glb = file.glb();
    let mut rng = fastrand::Rng::with_seed(31);
    for _ in 0..20_000 {
        let mut broken = glb.clone();
        for _ in 0..rng.usize(1..4) {
            let at = rng.usize(0..broken.len());
            broken[at] ^= 1 << rng.u32(0..8);
        }
        if let Ok(rig) = load_slice(&broken, &LoadOptions::default()) {
            use_rig(&rig);
        }
    }
    for cut in 0..glb.len() {
        // With the header as it was, and with the length that is left.
        let mut broken = glb[..cut].to_vec();
        assert!(
            load_slice(&broken, &LoadOptions::default()).is_err(),
            "cut at {cut}"
        );
        if cut >= 12 {
            broken[8..12].copy_from_slice(&(cut as u32).to_le_bytes());
            let _ = load_slice(&broken, &LoadOptions::default());
        }
    }
    // The header alone, claiming less than itself.
    let mut short = glb[..12].to_vec();
    short[8..12].fill(0);
    assert!(load_slice(&short, &LoadOptions::default()).is_err());
}
