//! A small valid file, the seed of import fuzzing.

use serde_json::{Value, json};

/// A square of two triangles on two joints, as the two chunks of a GLB: JSON and binary. [`super::import()`] takes them
/// with a zero between them.
///
/// The file has most of the features that an import reads: a skin, a clip with three kinds of interpolation, extras, a
/// rigid mesh without indices, and a sparse accessor.
pub fn square() -> (Vec<u8>, Vec<u8>) {
    let mut chunks = Chunks::default();
    let square = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];
    let positions = chunks.floats("VEC3", &square);
    chunks.accessors[positions]["min"] = json!([0, 0, 0]);
    chunks.accessors[positions]["max"] = json!([1, 1, 0]);
    let joints = chunks.accessor("VEC4", 5121, 4, &[0, 1, 0, 0].repeat(4));
    let weights = [
        1., 0., 0., 0., 1., 0., 0., 0., 0.25, 0.75, 0., 0., 0., 1., 0., 0.,
    ];
    let weights = chunks.floats("VEC4", &weights);
    let indices = [0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes);
    let indices = chunks.accessor("SCALAR", 5123, 6, indices.as_flattened());
    let mut binds = [[0.0f32; 16]; 2];
    for bind in &mut binds {
        for k in 0..4 {
            bind[5 * k] = 1.0;
        }
    }
    binds[1][13] = -1.0;
    let binds = chunks.floats("MAT4", binds.as_flattened());
    let times = chunks.floats("SCALAR", &[0.0, 1.0]);
    let turns = chunks.floats("VEC4", &[0., 0., 0., 1., 0., 0., 0.6, 0.8]);
    let moves = chunks.floats("VEC3", &[0., 1., 0., 0., 1.5, 0.]);
    let scales = chunks.floats("VEC3", &[[0., 0., 0., 1., 1., 1., 0., 0., 0.]; 2].concat());
    let triangle = chunks.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 0., 1.]);
    chunks.accessors[triangle]["min"] = json!([0, 0, 0]);
    chunks.accessors[triangle]["max"] = json!([1, 0, 1]);
    let places = chunks.accessor("SCALAR", 5121, 1, &[2]);
    let values = chunks.floats("VEC3", &[0.5, 0.0, 1.0]);
    chunks.accessors[triangle]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values}
    });
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"name": "armature", "children": [1, 3], "scale": [2, 2, 2]},
            {"name": "lower", "children": [2, 4, 5]},
            {"name": "upper", "translation": [0, 1, 0]},
            {"name": "body", "mesh": 0, "skin": 0},
            {"name": "horn", "mesh": 1, "rotation": [0, 0, 0.6, 0.8]},
            {"name": "heart", "extras": {"clamber": {"weak_point": {"hit_points": 3.0}}}}
        ],
        "materials": [{"extras": {"clamber": {"surface": "fur", "ledge": true}}}],
        "meshes": [
            {"primitives": [{
                "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights},
                "indices": indices, "material": 0
            }]},
            {"primitives": [{"attributes": {"POSITION": triangle}}]}
        ],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": binds}],
        "animations": [{
            "name": "turn",
            "channels": [
                {"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                {"sampler": 1, "target": {"node": 2, "path": "translation"}},
                {"sampler": 2, "target": {"node": 1, "path": "scale"}}
            ],
            "samplers": [
                {"input": times, "output": turns},
                {"input": times, "output": moves, "interpolation": "STEP"},
                {"input": times, "output": scales, "interpolation": "CUBICSPLINE"}
            ]
        }],
        "accessors": chunks.accessors,
        "bufferViews": chunks.views,
        "buffers": [{"byteLength": chunks.bytes.len()}]
    });
    (json.to_string().into_bytes(), chunks.bytes)
}

/// A GLB file of two chunks.
pub(crate) fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (name, chunk, filling) in [(b"JSON", json, b' '), (b"BIN\0", binary, 0)] {
        let length = chunk.len().next_multiple_of(4);
        glb.extend((length as u32).to_le_bytes());
        glb.extend(name);
        glb.extend(chunk);
        glb.resize(glb.len() + length - chunk.len(), filling);
    }
    let length = glb.len() as u32;
    glb[8..12].copy_from_slice(&length.to_le_bytes());
    glb
}

/// A buffer under construction, with its views and accessors.
#[derive(Default)]
struct Chunks {
    accessors: Vec<Value>,
    views: Vec<Value>,
    bytes: Vec<u8>,
}

impl Chunks {
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

    /// Appends an accessor with a view of its own; returns the index of both.
    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        }));
        self.bytes.extend_from_slice(bytes);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "count": count,
            "type": kind
        }));
        self.accessors.len() - 1
    }
}
