//! Collision meshes, visual meshes, rigid meshes and morph targets.

use clamber_gltf::{Alpha, GltfErrorKind, ImportWarning};
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::JointId;
use glam::{Vec2, Vec3};
use serde_json::json;

use crate::builder::{File, joint_names, posed, remove};

/// Numbers of triangles of the collider, and of visual meshes.
fn counts(file: &File) -> (usize, usize) {
    let model = file.load().unwrap();
    (model.rig.collider.triangles().len(), model.visual.len())
}

#[test]
fn visual_meshes_keep_normals_texture_coordinates_colours_and_materials() {
    let mut file = File::square();
    let normals = file.floats("VEC3", &[0.0, 0.0, 0.5].repeat(4));
    let corners = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let first = file.floats("VEC2", &corners);
    let second = file.accessor("VEC2", 5121, 4, &[0, 0, 255, 0, 255, 255, 0, 255]);
    file.json["accessors"][second]["normalized"] = json!(true);
    let colors = file.floats("VEC3", &[1.0, 0.5, 0.25].repeat(4));
    file.json["meshes"][0]["name"] = json!("pelt");
    let attributes = file.attributes();
    attributes["NORMAL"] = json!(normals);
    attributes["TEXCOORD_0"] = json!(first);
    attributes["TEXCOORD_1"] = json!(second);
    attributes["COLOR_0"] = json!(colors);
    attributes["COLOR_1"] = json!(colors);
    // The same vertices once more, with another material.
    let mut other = file.primitives()[0].clone();
    other["material"] = json!(1);
    file.primitives().push(other);
    let glow = json!({
        "name": "glow", "emissiveFactor": [0, 1, 1], "alphaMode": "MASK", "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5], "roughnessFactor": 0.25}
    });
    file.push("materials", glow);

    let model = file.load().unwrap();
    let names = vec!["COLOR_1".to_owned()];
    let unread = [ImportWarning::UnreadAttributes { names }];
    assert_eq!(model.report.warnings, unread);
    let text = unread[0].to_string();
    assert_eq!(text, "attributes that were not read: COLOR_1");
    let [seen] = model.visual.as_slice() else {
        panic!("{} visual meshes", model.visual.len());
    };
    assert_eq!(seen.name, "body");
    assert_eq!(seen.positions.len(), 4);
    assert_eq!(seen.normals, [Vec3::Z; 4]);
    let expected = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    assert_eq!(seen.tex_coords, [expected, expected]);
    assert_eq!(seen.colors, [[1.0, 0.5, 0.25, 1.0]; 4]);
    assert_eq!(seen.influence_ends, [1, 2, 3, 4]);
    let materials: Vec<_> = seen.primitives.iter().map(|p| p.material).collect();
    assert_eq!(materials, [Some(0), Some(1)]);
    let glow = &model.materials[1];
    assert_eq!(glow.name.as_deref(), Some("glow"));
    assert_eq!(glow.emissive, [0.0, 1.0, 1.0]);
    assert_eq!(glow.alpha, Alpha::Mask(0.5));
    assert_eq!((glow.base_color[3], glow.roughness), (0.5, 0.25));
    assert!(glow.double_sided);
    let again = model.visual_collider().unwrap();
    assert_eq!(again.triangles().len(), 2);
}

#[test]
fn visual_meshes_merge_into_one_collider_with_their_tags() {
    let mut file = File::square();
    let apart: [[f32; 3]; 3] = [[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
    let primitive = file.primitive_on(1, &apart);
    let positions = primitive["attributes"]["POSITION"].as_u64().unwrap() as usize;
    file.primitives().push(primitive);
    let model = file.load().unwrap();
    assert_eq!(model.visual.len(), 2);
    let seen = model.visual_collider().unwrap();
    assert_eq!(seen.positions(), model.rig.collider.positions());
    assert_eq!(seen.triangles(), model.rig.collider.triangles());
    assert_eq!(seen.tags(), model.rig.collider.tags());
    for vertex in (0..7).map(VertexId) {
        let wanted = model.rig.collider.influences(vertex);
        assert!(seen.influences(vertex).eq(wanted), "{vertex:?}");
    }

    // Positions may lack their range. Normals must be as many as positions.
    remove(&mut file.json["accessors"][positions], "min");
    remove(&mut file.json["accessors"][positions], "max");
    let normals = file.floats("VEC3", &[0.0; 6]);
    assert!(file.load().is_ok());
    let four = file.accessor("SCALAR", 5121, 4, &[0, 1, 2, 0]);
    file.primitives()[1]["indices"] = json!(four);
    file.assert_refused("has 4 corners, not a multiple of 3");
    remove(&mut file.primitives()[1], "indices");
    file.primitives()[1]["attributes"]["NORMAL"] = json!(normals);
    file.assert_refused("has 3 positions, but 2 normals");
}

#[test]
fn two_nodes_can_give_one_mesh_different_roles() {
    let role = |role: &str| json!({"clamber": {"role": role}});
    let mut file = File::square();
    file.json["nodes"][3]["extras"] = role("visual");
    file.node(json!({"mesh": 0, "skin": 0, "extras": role("collision")}));
    assert_eq!(counts(&file), (2, 1));
}

#[test]
fn roles_select_collision_and_visual_meshes() {
    let role = |role: &str| json!({"clamber": {"role": role}});
    let mut file = File::square();
    file.json["nodes"][3]["extras"] = role("visual");
    let none = file.load();
    assert!(matches!(none, Err(GltfErrorKind::NoTriangles { .. })));
    file.json["nodes"][3]["extras"] = role("collision");
    assert_eq!(counts(&file), (2, 0));

    // If one mesh is for collision, a mesh without a role is visual only.
    let primitive = file.primitive_on(0, &[[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]]);
    let seen = file.push("meshes", json!({"primitives": [primitive]}));
    let node = file.node(json!({"mesh": seen, "skin": 0}));
    assert_eq!(counts(&file), (2, 1));
    file.json["nodes"][node]["extras"] = role("both");
    assert_eq!(counts(&file), (3, 1));
    remove(&mut file.json["nodes"][3], "extras");
    assert_eq!(counts(&file), (3, 2));

    // The role of the mesh applies where its node has none.
    file.json["meshes"][0]["extras"] = role("visual");
    assert_eq!(counts(&file), (1, 2));

    file.json["nodes"][3]["extras"] = role("colission");
    file.assert_refused("extras of node \"body\"");
    file.assert_refused("`collision`");
}

#[test]
fn a_rigid_mesh_under_a_joint_follows_it_alone() {
    let mut file = File::square();
    let between = file.node_under(2, json!({"name": "mount", "scale": [1, 1, -1]}));
    let mut plate = file.json["meshes"][0].clone();
    plate["primitives"][0]["attributes"] =
        json!({"POSITION": plate["primitives"][0]["attributes"]["POSITION"]});
    let plate = file.push("meshes", plate);
    let node = json!({"name": "plate", "mesh": plate, "translation": [0, 0, 3]});
    file.node_under(between, node);
    // The same mesh once more, under no joint.
    file.node(json!({"mesh": plate}));

    let model = file.load().unwrap();
    let names = joint_names(&model);
    assert_eq!(names, ["lower", "upper", "plate", "armature", "mount"]);
    assert_eq!(model.rig.collider.triangles().len(), 4);
    // Equal positions in different spaces are no crack.
    assert_eq!(model.report.build.cracks, 0);
    assert_eq!(model.visual.len(), 2);
    let warnings = &model.report.warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_eq!(model.rig.collider.parts()[2].joint, JointId(2));

    // Turned about (0, 1) with "upper", doubled by "armature", mirrored by "mount".
    let surface = posed(&model, 1.0);
    let corner = surface.in_model().position(VertexId(4 + 1)).unwrap();
    let expected = Vec3::new(0.0, 2.0 + 2.0, -6.0);
    assert!((corner - expected).length() < 1e-5, "{corner}");
    let hit = surface.in_model().closest_point(expected, 1.0).unwrap();
    let part = &model.rig.collider.parts()[hit.part.index()];
    assert_eq!(part.joint, JointId(2));
}

#[test]
fn a_file_without_skins_is_one_creature_of_rigid_pieces() {
    let mut file = File::square();
    remove(&mut file.json, "skins");
    remove(&mut file.json["nodes"][3], "skin");
    file.json["nodes"][2]["mesh"] = json!(0);
    let model = file.load().unwrap();
    let names = joint_names(&model);
    assert_eq!(names, ["upper", "body", "lower", "armature"]);
    assert_eq!(model.rig.collider.triangles().len(), 4);
    assert_eq!(model.rig.clips.len(), 1);
    file.json["meshes"] = json!([{"primitives": []}]);
    assert!(matches!(
        file.load(),
        Err(GltfErrorKind::Format { .. } | GltfErrorKind::NoTriangles { .. })
    ));
}

#[test]
fn morph_targets_are_applied_at_their_rest_weights() {
    let mut file = File::square();
    let up = file.positions(&[[0.0, 0.0, 1.0]; 4]);
    let aside = file.positions(&[[4.0, 0.0, 0.0]; 4]);
    file.primitives()[0]["targets"] = json!([{"POSITION": up}, {"POSITION": aside}, {}]);
    let z = |file: &File| file.load().map(|model| model.rig.collider.positions()[0]);
    assert_eq!(z(&file).unwrap(), Vec3::ZERO, "no weights are zero weights");
    file.json["meshes"][0]["weights"] = json!([0.5]);
    file.assert_refused("3 morph targets, but 1 weights");
    file.json["meshes"][0]["weights"] = json!([0.5, 0.25, 1.0]);
    assert_eq!(z(&file).unwrap(), Vec3::new(1.0, 0.0, 0.5));
    file.json["nodes"][3]["weights"] = json!([2.0, 0.0, 0.0]);
    let found = z(&file).unwrap();
    assert_eq!(found, Vec3::Z * 2.0, "the node's weights win");

    // The same mesh with other weights is another mesh.
    file.node(json!({"mesh": 0, "skin": 0}));
    assert_eq!(file.load().unwrap().rig.collider.triangles().len(), 4);

    let short = file.positions(&[[0.0, 0.0, 1.0]; 3]);
    file.primitives()[0]["targets"][0] = json!({"POSITION": short});
    file.assert_refused("a morph target of 3");
}
