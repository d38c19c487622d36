//! Collision meshes, visual meshes, rigid meshes and morph targets.

use clamber_gltf::{Alpha, GltfErrorKind, ImportWarning};
use clamber_surface::mesh::VertexId;
use clamber_surface::rig::JointId;
use glam::{Vec2, Vec3};
use serde_json::json;

use crate::builder::{File, joint_names, posed};

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
    let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = json!(normals);
    attributes["TEXCOORD_0"] = json!(first);
    attributes["TEXCOORD_1"] = json!(second);
    attributes["COLOR_0"] = json!(colors);
    attributes["COLOR_1"] = json!(colors);
    // The same vertices once more, with another material.
    let mut other = file.json["meshes"][0]["primitives"][0].clone();
    other["material"] = json!(1);
    file.json["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(other);
    file.push(
        "materials",
        json!({
            "name": "glow", "emissiveFactor": [0, 1, 1], "alphaMode": "MASK", "doubleSided": true,
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5], "roughnessFactor": 0.25}
        }),
    );

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
    assert_eq!(
        (glow.emissive, glow.alpha),
        ([0.0, 1.0, 1.0], Alpha::Mask(0.5))
    );
    assert_eq!((glow.base_color[3], glow.roughness), (0.5, 0.25));
    assert!(glow.double_sided);
    let again = model.visual_collider().unwrap();
    assert_eq!(again.triangles().len(), 2);
}

#[test]
fn visual_meshes_merge_into_one_collider_with_their_tags() {
    let mut file = File::square();
    let apart: [[f32; 3]; 3] = [[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
    let positions = file.positions(&apart);
    let joints = file.accessor("VEC4", 5121, 3, &[1, 0, 0, 0].repeat(3));
    let weights = file.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let primitives = file.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {
        "POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}}));
    let model = file.load().unwrap();
    assert_eq!(model.visual.len(), 2);
    let seen = model.visual_collider().unwrap();
    assert_eq!(seen.positions(), model.rig.collider.positions());
    assert_eq!(seen.triangles(), model.rig.collider.triangles());
    assert_eq!(seen.tags(), model.rig.collider.tags());
    for vertex in (0..7).map(VertexId) {
        assert!(
            seen.influences(vertex)
                .eq(model.rig.collider.influences(vertex)),
            "{vertex:?}"
        );
    }

    // Positions may lack their range. Normals must be as many as positions.
    let accessor = file.json["accessors"][positions].as_object_mut().unwrap();
    accessor.remove("min");
    accessor.remove("max");
    let normals = file.floats("VEC3", &[0.0; 6]);
    assert!(file.load().is_ok());
    let four = file.accessor("SCALAR", 5121, 4, &[0, 1, 2, 0]);
    file.json["meshes"][0]["primitives"][1]["indices"] = json!(four);
    let error = file.load().unwrap_err().to_string();
    assert!(
        error.contains("has 4 corners, not a multiple of 3"),
        "{error}"
    );
    let primitive = file.json["meshes"][0]["primitives"][1]
        .as_object_mut()
        .unwrap();
    primitive.remove("indices");
    file.json["meshes"][0]["primitives"][1]["attributes"]["NORMAL"] = json!(normals);
    let error = file.load().unwrap_err().to_string();
    assert!(error.contains("has 3 positions, but 2 normals"), "{error}");
}

#[test]
fn two_nodes_can_give_one_mesh_different_roles() {
    let role = |role: &str| json!({"clamber": {"role": role}});
    let mut file = File::square();
    file.json["nodes"][3]["extras"] = role("visual");
    file.node(json!({"mesh": 0, "skin": 0, "extras": role("collision")}));
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (2, 1)
    );
}

#[test]
fn roles_select_collision_and_visual_meshes() {
    let role = |role: &str| json!({"clamber": {"role": role}});
    let mut file = File::square();
    file.json["nodes"][3]["extras"] = role("visual");
    assert!(matches!(
        file.load(),
        Err(GltfErrorKind::NoTriangles { .. })
    ));
    file.json["nodes"][3]["extras"] = role("collision");
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (2, 0)
    );

    // If one mesh is for collision, a mesh without a role is visual only.
    let mut seen = file.json["meshes"][0].clone();
    seen["primitives"].as_array_mut().unwrap().pop();
    let three: [[f32; 3]; 3] = [[0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
    let positions = file.positions(&three);
    let joints = file.accessor("VEC4", 5121, 3, &[0; 12]);
    let weights = file.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    seen["primitives"] = json!([{"attributes": {
        "POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}}]);
    let seen = file.push("meshes", seen);
    let node = file.node(json!({"mesh": seen, "skin": 0}));
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (2, 1)
    );
    file.json["nodes"][node]["extras"] = role("both");
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (3, 1)
    );
    file.json["nodes"][3]
        .as_object_mut()
        .unwrap()
        .remove("extras");
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (3, 2)
    );

    // The role of the mesh applies where its node has none.
    file.json["meshes"][0]["extras"] = role("visual");
    let model = file.load().unwrap();
    assert_eq!(
        (model.rig.collider.triangles().len(), model.visual.len()),
        (1, 2)
    );

    file.json["nodes"][3]["extras"] = role("colission");
    let error = file.load().unwrap_err().to_string();
    assert!(
        error.contains("extras of node \"body\"") && error.contains("`collision`"),
        "{error}"
    );
}

#[test]
fn a_rigid_mesh_under_a_joint_follows_it_alone() {
    let mut file = File::square();
    let between = file.node_under(2, json!({"name": "mount", "scale": [1, 1, -1]}));
    let mut plate = file.json["meshes"][0].clone();
    plate["primitives"][0]["attributes"] =
        json!({"POSITION": plate["primitives"][0]["attributes"]["POSITION"]});
    let plate = file.push("meshes", plate);
    file.node_under(
        between,
        json!({"name": "plate", "mesh": plate, "translation": [0, 0, 3]}),
    );
    // The same mesh once more, under no joint.
    file.node(json!({"mesh": plate}));

    let model = file.load().unwrap();
    let names = joint_names(&model);
    assert_eq!(names, ["lower", "upper", "plate", "armature", "mount"]);
    assert_eq!(model.rig.collider.triangles().len(), 4);
    assert_eq!(
        model.report.build.cracks, 0,
        "equal positions in different spaces"
    );
    assert_eq!(model.visual.len(), 2);
    assert_eq!(
        model.report.warnings.len(),
        1,
        "{:?}",
        model.report.warnings
    );
    assert_eq!(model.rig.collider.parts()[2].joint, JointId(2));

    // Turned about (0, 1) with "upper", doubled by "armature", mirrored by "mount".
    let surface = posed(&model, 1.0);
    let corner = surface.in_model().position(VertexId(4 + 1)).unwrap();
    let expected = Vec3::new(0.0, 2.0 + 2.0, -6.0);
    assert!((corner - expected).length() < 1e-5, "{corner}");
    let hit = surface.in_model().closest_point(expected, 1.0).unwrap();
    assert_eq!(
        model.rig.collider.parts()[hit.part.index()].joint,
        JointId(2)
    );
}

#[test]
fn a_file_without_skins_is_one_creature_of_rigid_pieces() {
    let mut file = File::square();
    file.json.as_object_mut().unwrap().remove("skins");
    file.json["nodes"][3]
        .as_object_mut()
        .unwrap()
        .remove("skin");
    file.json["nodes"][2]["mesh"] = json!(0);
    let model = file.load().unwrap();
    let names = joint_names(&model);
    assert_eq!(names, ["upper", "body", "lower", "armature"]);
    assert_eq!(
        (model.rig.collider.triangles().len(), model.rig.clips.len()),
        (4, 1)
    );
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
    file.json["meshes"][0]["primitives"][0]["targets"] =
        json!([{"POSITION": up}, {"POSITION": aside}, {}]);
    let z = |file: &File| file.load().map(|model| model.rig.collider.positions()[0]);
    assert_eq!(z(&file).unwrap(), Vec3::ZERO, "no weights are zero weights");
    file.json["meshes"][0]["weights"] = json!([0.5]);
    let error = z(&file).unwrap_err().to_string();
    assert!(error.contains("3 morph targets, but 1 weights"), "{error}");
    file.json["meshes"][0]["weights"] = json!([0.5, 0.25, 1.0]);
    assert_eq!(z(&file).unwrap(), Vec3::new(1.0, 0.0, 0.5));
    file.json["nodes"][3]["weights"] = json!([2.0, 0.0, 0.0]);
    assert_eq!(
        z(&file).unwrap(),
        Vec3::new(0.0, 0.0, 2.0),
        "the node's weights win"
    );

    // The same mesh with other weights is another mesh.
    file.node(json!({"mesh": 0, "skin": 0}));
    assert_eq!(file.load().unwrap().rig.collider.triangles().len(), 4);

    let short = file.positions(&[[0.0, 0.0, 1.0]; 3]);
    file.json["meshes"][0]["primitives"][0]["targets"][0] = json!({"POSITION": short});
    let error = file.load().unwrap_err().to_string();
    assert!(error.contains("a morph target of 3"), "{error}");
}
