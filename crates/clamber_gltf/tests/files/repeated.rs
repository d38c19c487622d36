//! Meshes that are shown many times: they are read once, and the vertices of further showings have a limit of their
//! own.

use clamber_gltf::{GltfErrorKind, LoadOptions};
use serde_json::json;

use crate::builder::File;

/// Adds a sphere of 25 by 25 vertices to a file; returns the index of its mesh.
fn sphere(file: &mut File) -> usize {
    let (rings, sides) = (25, 25);
    let angle = |k: usize, of: usize| k as f32 / (of - 1) as f32 * std::f32::consts::PI;
    let point = |(ring, side): (usize, usize)| {
        let (up, round) = (angle(ring, rings), 2.0 * angle(side, sides));
        [
            libm::sinf(up) * libm::cosf(round),
            libm::cosf(up),
            libm::sinf(up) * libm::sinf(round),
        ]
    };
    let all = (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side)));
    let points: Vec<[f32; 3]> = all.map(point).collect();
    let positions = file.positions(&points);
    let normals = file.floats("VEC3", points.as_flattened());
    let mut indices = Vec::new();
    for ring in 0..rings as u16 - 1 {
        for side in 0..sides as u16 - 1 {
            let at = ring * sides as u16 + side;
            let below = at + sides as u16;
            indices.extend([at, at + 1, below, at + 1, below + 1, below]);
        }
    }
    let count = indices.len();
    let bytes: Vec<u8> = indices.into_iter().flat_map(u16::to_le_bytes).collect();
    let indices = file.accessor("SCALAR", 5123, count, &bytes);
    let primitive =
        json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices});
    file.push("meshes", json!({"primitives": [primitive]}))
}

#[test]
fn a_centipede_of_300_segments_of_one_sphere_loads() {
    let mut file = File::square();
    let mesh = sphere(&mut file);
    let mut parent = 1;
    for segment in 0..300 {
        let name = format!("segment {segment}");
        parent = file.node_under(
            parent,
            json!({"name": name, "mesh": mesh, "translation": [0, 0, 1]}),
        );
    }
    // Each segment but the first counts, and the limit is exact.
    let repeated = 299 * 625;
    for (limit, loads) in [(1 << 20, true), (repeated, true), (repeated - 1, false)] {
        let options = LoadOptions::default().with_max_repeated_vertices(limit);
        match file.load_with(&options) {
            Ok(model) => {
                assert!(loads, "limit {limit}");
                assert_eq!(model.visual.len(), 301);
                let vertices: usize = model.visual.iter().map(|mesh| mesh.positions.len()).sum();
                assert_eq!(vertices, 300 * 625 + 4);
                assert_eq!(model.rig.skeleton.joints().len(), 303);
            }
            Err(error) => {
                assert!(!loads, "limit {limit}: {error}");
                let text = "meshes that are shown more than once make over 186874 vertices";
                assert!(error.to_string().contains(text), "{error}");
                assert!(matches!(
                    error,
                    GltfErrorKind::TooManyRepeats { limit: 186_874, .. }
                ));
            }
        }
    }
}

#[test]
fn a_crowd_of_100_loads_with_one_mesh() {
    let mut file = File::square();
    let mesh = sphere(&mut file);
    let vertices = 625;
    let joints = file.accessor("VEC4", 5121, vertices, &[0, 1, 2, 3].repeat(vertices));
    let weights = file.accessor("VEC4", 5121, vertices, &[100, 100, 50, 5].repeat(vertices));
    file.json["accessors"][weights]["normalized"] = json!(true);
    let attributes = &mut file.json["meshes"][mesh]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    for person in 0..100 {
        let root = file.node(json!({"name": format!("person {person}")}));
        let mut all = vec![root];
        for limb in 0..30 {
            let parent = all[limb];
            all.push(file.node_under(parent, json!({"translation": [0, 1, 0]})));
        }
        let skin = file.push("skins", json!({"joints": all}));
        file.node(json!({"mesh": mesh, "skin": skin}));
    }
    let models = file.load_all("crowd");
    assert_eq!(models.len(), 101);
    let positions = models[1].rig.collider.positions().len();
    for model in &models[1..] {
        let found = (model.rig.collider.positions().len(), model.visual.len());
        assert_eq!(found, (positions, 1));
    }
    assert!(positions >= 577, "{positions}");
    // A single member repeats no vertex.
    let alone = LoadOptions::default()
        .with_skin(50)
        .with_max_repeated_vertices(0);
    assert!(file.load_with(&alone).is_ok());
}
