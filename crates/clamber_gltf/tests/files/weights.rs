//! Weights and joint indices as exporters write them.

use clamber_gltf::ImportWarning;
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::JointId;
use serde_json::json;

use crate::builder::File;

/// The joints and weights of the square's vertices, after loading.
fn weights_of(file: &File) -> Vec<Vec<(u32, f32)>> {
    let collider = file.load().unwrap().rig.collider;
    let vertex = |v| {
        collider
            .influences(VertexId(v))
            .map(|(JointId(j), w)| (j, w))
            .collect()
    };
    (0..4).map(vertex).collect()
}

/// Replaces an attribute of the square.
fn replace(file: &mut File, attribute: &str, accessor: usize) {
    file.attributes()[attribute] = json!(accessor);
}

#[test]
fn every_component_type_gives_the_same_weights() {
    let expected = weights_of(&File::square());
    let shares = [
        [1.0f32, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
    ];
    let shares = shares.as_flattened().iter();
    let bytes: Vec<u8> = shares.clone().map(|w| (w * 255.0) as u8).collect();
    let words = shares.flat_map(|w| ((w * 65535.0) as u16).to_le_bytes());
    let words: Vec<u8> = words.collect();
    for (component, data) in [(5121, &bytes), (5123, &words)] {
        let mut file = File::square();
        let weights = file.accessor("VEC4", component, 4, data);
        file.json["accessors"][weights]["normalized"] = json!(true);
        replace(&mut file, "WEIGHTS_0", weights);
        assert_eq!(weights_of(&file), expected, "{component}");
    }
    let mut file = File::square();
    let joints = [[0u16, 1, 0, 0]; 4].map(|joints| joints.map(u16::to_le_bytes));
    let joints = joints.as_flattened().as_flattened();
    let joints = file.accessor("VEC4", 5123, 4, joints);
    replace(&mut file, "JOINTS_0", joints);
    assert_eq!(weights_of(&file), expected, "joints of 16 bits");
    // Signed integers cannot name joints.
    let joints = file.accessor("VEC4", 5120, 4, &[0; 16]);
    replace(&mut file, "JOINTS_0", joints);
    assert!(file.load().is_err());
}

#[test]
fn weights_that_do_not_sum_to_one_are_normalised_and_reported() {
    let mut file = File::square();
    let weights = file.floats("VEC4", &[0.5, 1.0, 0.0, 0.0].repeat(4));
    replace(&mut file, "WEIGHTS_0", weights);
    let third = (1u32 << 24) as f32 / 3.0;
    for vertex in weights_of(&file) {
        let [(0, a), (1, b)] = vertex[..] else {
            panic!("{vertex:?}");
        };
        assert_eq!(a + b, 1.0);
        assert!((a * (1u32 << 24) as f32 - third).abs() <= 1.0, "{a}");
    }
    assert_eq!(file.load().unwrap().report.build.worst_weight_error, 0.5);
    // All weights are zero: the first joint named moves the vertex.
    let weights = file.floats("VEC4", &[0.0; 16]);
    replace(&mut file, "WEIGHTS_0", weights);
    let model = file.load().unwrap();
    let unweighted = ImportWarning::UnweightedVertices { vertices: 4 };
    assert_eq!(model.report.warnings, [unweighted]);
    assert_eq!(model.report.build.worst_weight_error, 0.0);
    assert_eq!(weights_of(&file)[2], [(0, 1.0)]);
    for bad in [-1.0, f32::NAN, f32::INFINITY] {
        let weights = file.floats("VEC4", &[bad, 1.0, 0.0, 0.0].repeat(4));
        replace(&mut file, "WEIGHTS_0", weights);
        let error = file.load().unwrap_err().to_string();
        assert!(error.contains("cannot be normalised"), "{bad}: {error}");
    }
}

#[test]
fn further_sets_add_influences_and_a_half_set_is_refused() {
    let mut file = File::square();
    let joints = file.accessor("VEC4", 5121, 4, &[1, 0, 0, 0].repeat(4));
    let weights = file.floats("VEC4", &[1.0, 1.0, 0.0, 0.0].repeat(4));
    replace(&mut file, "JOINTS_1", joints);
    file.assert_refused("only one of JOINTS_1 and WEIGHTS_1");
    replace(&mut file, "WEIGHTS_1", weights);
    // The first joint had all the weight. Now it has two thirds, and the other one a third.
    let two_thirds = weights_of(&file)[0][0].1;
    assert!((two_thirds - 2.0 / 3.0).abs() < 1e-6, "{two_thirds}");
}
