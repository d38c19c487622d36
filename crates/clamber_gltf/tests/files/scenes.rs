//! Which scene of a file is loaded.

use clamber_gltf::{GltfErrorKind, ImportWarning, LoadOptions, Model};
use serde_json::json;

use crate::builder::{File, remove};

/// Two squares in scenes of their own, 1 and 2; scene 0 is empty, and a third square is in no scene.
fn two_scenes() -> File {
    let mut file = File::square();
    let second = file.push("nodes", json!({"name": "second", "mesh": 0}));
    file.push("nodes", json!({"name": "third", "mesh": 0}));
    file.json["scenes"] = json!([{}, {"nodes": [0]}, {"nodes": [second], "name": "other"}]);
    remove(&mut file.json, "scene");
    file
}

fn names(model: &Model) -> Vec<&str> {
    model.visual.iter().map(|mesh| mesh.name.as_str()).collect()
}

#[test]
fn the_default_scene_is_loaded_or_the_first_with_a_mesh_or_the_wanted_one() {
    let mut file = two_scenes();
    let model = file.load().unwrap();
    assert_eq!(names(&model), ["body"]);
    let warning = ImportWarning::HiddenMeshes {
        scene: 1,
        meshes: 2,
    };
    assert_eq!(model.report.warnings, [warning]);
    let text = model.report.warnings[0].to_string();
    assert_eq!(
        text,
        "loaded scene 1; left out meshes that it does not show: 2"
    );

    // A skin that no shown mesh uses is no creature.
    let in_scene = |file: &File, scene| {
        let model = file.load_with(&LoadOptions::default().with_scene(scene));
        names(&model.unwrap()).join(" ")
    };
    assert_eq!(in_scene(&file, 2), "second");
    file.json["scene"] = json!(2);
    assert_eq!(names(&file.load().unwrap()), ["second"]);
    assert_eq!(in_scene(&file, 1), "body");

    // Without scenes everything is shown.
    remove(&mut file.json, "scene");
    remove(&mut file.json, "scenes");
    let model = file.load().unwrap();
    assert_eq!(names(&model), ["body"]);
    let warning = ImportWarning::MeshesWithoutJoint { meshes: 2 };
    assert_eq!(model.report.warnings, [warning]);
}

#[test]
fn a_mesh_below_a_root_is_shown_and_its_joints_may_be_elsewhere() {
    // Against the specification, the scene names the mesh but not the joints of its skin.
    let mut file = File::square();
    file.json["scenes"] = json!([{"nodes": [3]}]);
    file.json["nodes"][0]["children"] = json!([1]);
    let model = file.load().unwrap();
    assert_eq!(model.rig.skeleton.joints().len(), 3);
    assert_eq!(model.report.warnings, []);
}

#[test]
fn empty_scenes_are_no_error_and_a_scene_without_a_mesh_says_which_has_one() {
    let mut file = two_scenes();
    file.json["scenes"][0] = json!({"nodes": []});
    assert!(file.load().is_ok());
    file.json["scene"] = json!(0);
    let error = file.load().unwrap_err();
    let kind = GltfErrorKind::EmptyScene {
        scene: 0,
        other: Some(1),
    };
    assert_eq!(format!("{error:?}"), format!("{kind:?}"));
    let text = "scene 0 shows no mesh, but scene 1 does: choose it with LoadOptions::with_scene";
    assert_eq!(error.to_string(), text);

    file.json["scenes"] = json!([{}]);
    let text = "scene 0 shows no mesh, and no other scene does: the file's meshes are in none";
    assert_eq!(file.load().unwrap_err().to_string(), text);

    // A file without any mesh has another error.
    for node in file.json["nodes"].as_array_mut().unwrap() {
        remove(node, "mesh");
    }
    let error = file.load().unwrap_err();
    assert!(
        matches!(error, GltfErrorKind::NoTriangles { .. }),
        "{error}"
    );
}

/// The search for a scene with a mesh takes one pass through a file, not one for each scene.
#[test]
fn many_scenes_of_many_nodes_load_in_one_pass() {
    /// Number of added nodes, and of scenes without a mesh. A pass for each scene would visit 10^10 nodes.
    const MANY: usize = 100_000;
    let mut file = two_scenes();
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    nodes.extend((0..MANY).map(|_| json!({})));
    // The last scene shows a mesh through a node above it.
    let above = file.push("nodes", json!({"children": [0]}));
    let mut scenes = vec![json!({"nodes": [above - 1, above - 2]}); MANY];
    scenes.push(json!({"nodes": [above]}));
    file.json["scenes"] = scenes.into();
    let model = file.load().unwrap();
    assert_eq!(model.visual.len(), 1);

    file.json["scene"] = json!(0);
    let error = file.load().unwrap_err();
    let named = matches!(
        error,
        GltfErrorKind::EmptyScene {
            scene: 0,
            other: Some(MANY)
        }
    );
    assert!(named, "{error}");
}

#[test]
fn scenes_that_do_not_exist_are_refused() {
    let file = two_scenes();
    let options = LoadOptions::default().with_scene(3);
    let error = file.load_with(&options).unwrap_err();
    assert!(
        matches!(
            error,
            GltfErrorKind::NoSuchScene {
                wanted: 3,
                found: 3
            }
        ),
        "{error}"
    );
    for scene in [json!(3), json!(-1), json!("first")] {
        let mut file = two_scenes();
        file.json["scene"] = scene;
        file.assert_refused("the default scene: is");
    }
    // The nodes of the loaded scene are checked; the nodes of other scenes are never read.
    for (nodes, text) in [
        (json!([0, 99]), "names node 99"),
        (json!(["a"]), "is no index"),
    ] {
        let mut file = two_scenes();
        file.json["scenes"][2]["nodes"] = nodes;
        assert!(file.load().is_ok());
        let error = file.load_with(&LoadOptions::default().with_scene(2));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(text), "{error}");
    }
}

#[test]
fn all_creatures_are_those_of_the_scene() {
    let mut file = File::square();
    let second = file.push("nodes", json!({"name": "bone"}));
    let skin = file.push("skins", json!({"joints": [second, second]}));
    let mesh = file.push("nodes", json!({"name": "pet", "mesh": 0, "skin": skin}));
    for (nodes, creatures) in [(json!([0]), 1), (json!([0, second, mesh]), 2)] {
        file.json["scenes"] = json!([{"nodes": nodes}]);
        assert_eq!(file.load_all("scenes").len(), creatures, "{nodes}");
    }
}
