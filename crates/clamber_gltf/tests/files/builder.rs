//! Builds small files in code.

use clamber_gltf::{GltfErrorKind, LoadOptions, Model, load_all, load_slice};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Playback;
use clamber_surface::surface::SkinnedSurface;
use serde_json::{Value, json};

/// A document under construction: JSON, and the bytes of its one buffer.
pub(crate) struct File {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl File {
    /// A square of two triangles on two joints. A clip turns the upper joint. The joints are under a plain node.
    pub(crate) fn square() -> Self {
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
        let positions = file.positions(&square);
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

    pub(crate) fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        self.accessor(kind, 5126, values.len() / width, &bytes)
    }

    /// Appends an accessor of positions with their range.
    pub(crate) fn positions(&mut self, points: &[[f32; 3]]) -> usize {
        let index = self.floats("VEC3", points.as_flattened());
        let range = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            let of = |k: usize| points.iter().map(move |p| p[k]);
            (0..3).filter_map(|k| of(k).reduce(pick)).collect()
        };
        self.json["accessors"][index]["min"] = json!(range(f32::min));
        self.json["accessors"][index]["max"] = json!(range(f32::max));
        index
    }

    /// Appends vertices that follow one joint alone; returns a primitive of them.
    pub(crate) fn primitive_on(&mut self, joint: u8, points: &[[f32; 3]]) -> Value {
        let count = points.len();
        let positions = self.positions(points);
        let joints = self.accessor("VEC4", 5121, count, &[joint, 0, 0, 0].repeat(count));
        let weights = self.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(count));
        json!({"attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}})
    }

    /// The attributes of the square's primitive.
    pub(crate) fn attributes(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]["attributes"]
    }

    /// The primitives of the square's mesh.
    pub(crate) fn primitives(&mut self) -> &mut Vec<Value> {
        self.json["meshes"][0]["primitives"].as_array_mut().unwrap()
    }

    /// Appends to an array of the document; returns the index.
    pub(crate) fn push(&mut self, array: &str, value: Value) -> usize {
        if self.json.get(array).is_none() {
            self.json[array] = json!([]);
        }
        let items = self.json[array].as_array_mut().unwrap();
        items.push(value);
        items.len() - 1
    }

    /// Appends a node to the first scene; returns its index.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        let roots = self.json["scenes"][0]["nodes"].as_array_mut().unwrap();
        roots.push(json!(index));
        index
    }

    /// Appends a node under another one; returns its index.
    pub(crate) fn node_under(&mut self, parent: usize, node: Value) -> usize {
        let index = self.push("nodes", node);
        let parent = self.json["nodes"][parent].as_object_mut().unwrap();
        let children = parent.entry("children").or_insert_with(|| json!([]));
        children.as_array_mut().unwrap().push(json!(index));
        index
    }

    /// Appends an accessor with a view of its own; returns its index.
    pub(crate) fn accessor(
        &mut self,
        kind: &str,
        component: u32,
        count: usize,
        bytes: &[u8],
    ) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        });
        self.bytes.extend_from_slice(bytes);
        let view = self.push("bufferViews", view);
        let accessor = json!({
            "bufferView": view, "componentType": component, "count": count, "type": kind
        });
        self.push("accessors", accessor)
    }

    /// The file as a GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json.is_object() && json.get("buffers").is_none() {
            json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        }
        glb_of(&serde_json::to_vec(&json).unwrap(), &self.bytes)
    }

    /// The file as a `.gltf` whose buffer is at a URI.
    pub(crate) fn gltf(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        serde_json::to_vec(&json).unwrap()
    }

    pub(crate) fn load(&self) -> Result<Model, GltfErrorKind> {
        self.load_with(&LoadOptions::default())
    }

    pub(crate) fn load_with(&self, options: &LoadOptions) -> Result<Model, GltfErrorKind> {
        load_slice(&self.glb(), options).map_err(|error| error.kind)
    }

    /// All creatures of the file, loaded from a temporary path that contains `name`.
    pub(crate) fn load_all(&self, name: &str) -> Vec<Model> {
        let path = std::env::temp_dir().join(format!("clamber-{name}-{}.glb", std::process::id()));
        std::fs::write(&path, self.glb()).unwrap();
        let models = load_all(&path, &LoadOptions::default());
        std::fs::remove_file(&path).unwrap();
        models.unwrap()
    }

    /// Asserts that the file is refused with an error that contains a text.
    #[track_caller]
    pub(crate) fn assert_refused(&self, text: &str) {
        let error = self.load().unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
}

/// Removes a member of a JSON object.
pub(crate) fn remove(object: &mut Value, member: &str) {
    object.as_object_mut().unwrap().remove(member);
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

/// The names of a rig's joints, in order.
pub(crate) fn joint_names(model: &Model) -> Vec<&str> {
    let joints = model.rig.skeleton.joints().iter();
    joints.map(|joint| joint.name.as_str()).collect()
}

/// The rig's surface, posed at a time of its first clip.
pub(crate) fn posed(model: &Model, time: f64) -> SkinnedSurface {
    let rest = model.rig.skeleton.rest_pose();
    let pose = model.rig.clips[0]
        .sample(&rest, time, Playback::Clamp)
        .unwrap();
    let palette = model.rig.skeleton.palette(&pose).unwrap();
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    surface.advance(&palette, Similarity::IDENTITY).unwrap();
    surface
}
