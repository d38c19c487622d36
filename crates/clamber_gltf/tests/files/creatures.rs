//! Skins, joints, clips and weak points.

use clamber_gltf::{GltfErrorKind, ImportWarning, LoadOptions, load_slice};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{SurfaceKind, VertexId};
use clamber_surface::rig::JointId;
use glam::Vec3;
use serde_json::json;

use crate::builder::{File, joint_names, posed};

#[test]
fn the_square_loads_as_it_was_made() {
    let model = File::square().load().unwrap();
    assert_eq!(model.report.warnings, []);
    let names = joint_names(&model);
    assert_eq!(names, ["lower", "upper", "armature"]);
    assert_eq!(model.rig.skeleton.joints()[0].parent, Some(JointId(2)));
    assert_eq!(model.rig.collider.positions().len(), 4);
    let mut tags = model.rig.collider.tags().iter();
    assert!(tags.all(|tag| tag.kind == SurfaceKind::Fur));
    // At half time the upper edge has turned by 45 degrees about (0, 1), at twice the size.
    assert_eq!(model.rig.clips[0].name, "turn");
    let surface = posed(&model, 0.5);
    let corner = surface.in_model().position(VertexId(2)).unwrap();
    let diagonal = 2.0 * 0.5f32.sqrt();
    let expected = glam::Vec3::new(diagonal, 2.0 + diagonal, 0.0);
    assert!((corner - expected).length() < 1e-6, "{corner} {expected}");
}

#[test]
fn harmless_extensions_and_unused_channels_meshes_and_skins_are_skipped() {
    let mut file = File::square();
    file.json["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_mesh_quantization"]);
    file.json["extensionsRequired"] = file.json["extensionsUsed"].clone();
    let channels = file.json["animations"][0]["channels"]
        .as_array_mut()
        .unwrap();
    channels.push(json!({"sampler": 0, "target": {"path": "rotation"}}));
    channels.push(json!({"sampler": 0, "target": {"node": 1, "path": "pointer"}}));
    // A channel of a node outside the skeleton, with values that do not fit.
    channels.push(json!({"sampler": 0, "target": {"node": 3, "path": "scale"}}));
    file.push("nodes", json!({"mesh": 0}));
    let bare = file.node(json!({}));
    file.push("skins", json!({"joints": [bare]}));
    let model = file.load().unwrap();
    assert_eq!(model.rig.clips[0].channels().len(), 1);
    let warnings = &model.report.warnings;
    assert_eq!(warnings.len(), 5, "{warnings:?}");

    file.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(matches!(file.load(), Err(GltfErrorKind::Format { .. })));
}

#[test]
fn surplus_bind_matrices_are_ignored_and_unknown_joints_refused() {
    // A third bind matrix is legal, with any contents, and belongs to no joint.
    let mut file = File::square();
    let mut binds = [f32::NAN; 48];
    for k in 0..8 {
        binds[4 * k..4 * k + 4].fill(0.0);
        binds[4 * k + k % 4] = 1.0;
    }
    let binds = file.floats("MAT4", &binds);
    file.json["skins"][0]["inverseBindMatrices"] = json!(binds);
    let model = file.load().unwrap();
    let joint = &model.rig.skeleton.joints()[2];
    assert_eq!(joint.inverse_bind, Affine::IDENTITY);

    let mut file = File::square();
    file.json["skins"][0]["joints"] = json!([1]);
    file.assert_refused("joint 1 of a skin of 1");
    // With a weight of 0, the unknown joint is padding.
    let all_on_joint_0 = file.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(4));
    file.attributes()["WEIGHTS_0"] = json!(all_on_joint_0);
    file.json["animations"] = json!([]);
    assert!(file.load().is_ok());
    file.json["skins"][0]["joints"] = json!([1, 2, 0]);
    file.assert_refused("2 inverse bind matrices");
}

#[test]
fn animated_nodes_above_the_joints_move_them_at_any_scale() {
    let mut file = File::square();
    // From doubled, through zero, to mirrored and non-uniform.
    let times = file.floats("SCALAR", &[0.0, 1.0, 2.0]);
    let scales = file.floats("VEC3", &[2.0, 2.0, 2.0, 0.0, 0.0, 0.0, -3.0, 1e-6, 1.0]);
    let animation = &mut file.json["animations"][0];
    let samplers = animation["samplers"].as_array_mut().unwrap();
    samplers.push(json!({"input": times, "output": scales}));
    let channels = animation["channels"].as_array_mut().unwrap();
    channels.push(json!({"sampler": 1, "target": {"node": 0, "path": "scale"}}));
    // The channel of the joint is removed: only the node above the joints moves.
    channels.remove(0);
    let model = file.load().unwrap();
    for (time, scale) in [
        (0.0, Vec3::splat(2.0)),
        (0.5, Vec3::ONE),
        (1.0, Vec3::ZERO),
        (2.0, Vec3::new(-3.0, 1e-6, 1.0)),
    ] {
        let expected = Vec3::new(1.0, 1.0, 0.0) * scale;
        let found = posed(&model, time).in_model().position(VertexId(2));
        assert_eq!(found, Some(expected), "at {time} s");
    }
}

/// Adds a second pair of joints, under a root of their own, and a mesh on them.
fn with_a_stranger(file: &mut File) {
    let root = file.node(json!({"name": "stranger", "translation": [9, 0, 0]}));
    let tip = file.node_under(root, json!({"name": "its tip"}));
    let binds = file.json["skins"][0]["inverseBindMatrices"].clone();
    let skin = json!({"joints": [root, tip], "inverseBindMatrices": binds});
    let skin = file.push("skins", skin);
    file.node(json!({"mesh": 0, "skin": skin}));
}

#[test]
fn skins_that_share_joints_are_one_creature_and_others_another_one() {
    let mut file = File::square();
    // The same nodes in reverse order, without bind matrices.
    let again = file.push("skins", json!({"joints": [2, 1]}));
    let twice = json!({"mesh": 0, "skin": again});
    file.node(twice.clone());
    file.node(twice);
    // A joint under a joint of another skin.
    let finger = file.node_under(2, json!({"name": "finger"}));
    let nail = file.node_under(finger, json!({"name": "nail"}));
    let third = file.push("skins", json!({"joints": [finger, nail]}));
    file.node(json!({"mesh": 0, "skin": third}));
    with_a_stranger(&mut file);

    let model = file.load().unwrap();
    let names = joint_names(&model);
    // Two skins bind "lower" alike, but "upper" with different matrices.
    let expected = ["lower", "upper", "upper", "finger", "nail", "armature"];
    assert_eq!(names, expected);
    assert_eq!(model.rig.skeleton.joints()[3].parent, Some(JointId(1)));
    // A mesh that is shown twice is one, and each skin has a space of its own.
    assert_eq!(model.rig.collider.triangles().len(), 6);
    assert_eq!(model.report.build.cracks, 0);
    let expected = ImportWarning::OtherCreatures {
        skins: vec![0, 1, 2],
        others: 1,
    };
    let text = expected.to_string();
    assert_eq!(model.report.warnings, [expected]);
    assert!(text.contains("creature of skins 0, 1, 2; skipped other creatures: 1"));

    let pick = |skin| LoadOptions::default().with_skin(skin);
    let stranger = load_slice(&file.glb(), &pick(3)).unwrap();
    assert_eq!(stranger.rig.skeleton.joints()[0].name, "stranger");
    assert!(stranger.rig.clips.is_empty(), "the clip moves the others");
    let same = load_slice(&file.glb(), &pick(2)).unwrap();
    assert_eq!(same.rig.skeleton.joints().len(), 6);
    let error = load_slice(&file.glb(), &pick(4)).unwrap_err();
    assert!(error.path.is_none());
    let GltfErrorKind::NoSuchSkin { wanted, found } = error.kind else {
        panic!("{error}");
    };
    assert_eq!((wanted, found), (4, 4));
}

#[test]
fn load_all_gives_all_creatures_of_a_file() {
    let mut file = File::square();
    with_a_stranger(&mut file);
    // A second skin of the stranger.
    let joints = file.json["skins"][1]["joints"].clone();
    let second = file.push("skins", json!({"joints": joints}));
    file.node(json!({"mesh": 0, "skin": second}));
    let models = file.load_all("all");
    let told = models.iter().map(|model| {
        let first = &model.rig.skeleton.joints()[0];
        (first.name.as_str(), model.rig.collider.triangles().len())
    });
    let told: Vec<_> = told.collect();
    assert_eq!(told, [("lower", 2), ("stranger", 4)]);
    assert_eq!(models[0].rig.clips.len(), 1);
}

#[test]
fn weak_points_are_on_the_joint_that_they_hang_under() {
    let mut file = File::square();
    let between = file.node_under(2, json!({"translation": [0, 1, 0], "scale": [2, 2, 2]}));
    let says = |json| json!({"clamber": {"weak_point": json}});
    let eye = json!({"name": "eye", "translation": [1, 0, 0], "scale": [0.4, 0.4, -0.4],
        "extras": says(json!({"hit_points": 3.0, "major": true}))});
    file.node_under(between, eye);
    file.json["nodes"][1]["extras"] = says(json!({"hit_points": 1, "radius": 0.25}));
    file.node(json!({"extras": says(json!({"hit_points": 1}))}));

    let model = file.load().unwrap();
    let [lower, eye] = model.rig.weak_points.as_slice() else {
        panic!("{:?}", model.rig.weak_points);
    };
    assert_eq!((lower.joint, lower.position), (JointId(0), Vec3::ZERO));
    assert!(!lower.major && lower.hit_points == 1.0 && lower.name == "lower");
    let place = Vec3::new(2.0, 1.0, 0.0);
    assert_eq!((eye.joint, eye.position), (JointId(1), place));
    assert!(eye.major && eye.hit_points == 3.0 && eye.name == "eye");
    // The first radius is in the file. The second is the scale of the node, 0.4, under a node of scale 2, in an
    // armature of scale 2.
    assert_eq!((lower.radius, eye.radius), (0.25, 0.4 * 2.0 * 2.0));
    let [warning] = model.report.warnings.as_slice() else {
        panic!("{:?}", model.report.warnings);
    };
    assert!(matches!(warning, ImportWarning::WeakPointWithoutJoint { node } if node == "node 6"));

    for bad in [
        json!({"hit_points": 0}),
        json!({"hit_points": -1}),
        json!({"hit_points": 1, "radius": -0.5}),
        json!({"hit_points": 1, "radius": 1e39}),
        json!({}),
        json!(3),
    ] {
        file.json["nodes"][1]["extras"] = says(bad.clone());
        let error = file.load().unwrap_err().to_string();
        assert!(error.contains("extras of node \"lower\""), "{bad}: {error}");
    }
}

#[test]
fn nodes_in_a_cycle_are_refused() {
    let mut file = File::square();
    file.json["nodes"][2]["children"] = json!([0]);
    file.assert_refused("one of its own ancestors");
}
