//! Tags from the file and from the caller.

use clamber_gltf::{ImportWarning, LoadOptions, Model};
use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
use serde_json::json;

use crate::builder::{File, remove};

/// A file of three primitives: with the square's unnamed fur material, with "horn", and without a material.
fn three() -> File {
    let mut file = File::square();
    let extras = json!({"clamber": {"surface": "stone", "user": 7}});
    file.push("materials", json!({"name": "horn", "extras": extras}));
    for height in [1.0, 2.0] {
        let at = |x, y| [x, y, height];
        let points = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)];
        let positions = file.positions(&points);
        let mut primitive = json!({"attributes": {"POSITION": positions}});
        if height == 1.0 {
            primitive["material"] = json!(1);
        }
        file.primitives().push(primitive);
    }
    // The meshes are rigid, so positions suffice.
    remove(&mut file.json, "skins");
    remove(&mut file.json["nodes"][3], "skin");
    file
}

fn load(options: &LoadOptions) -> Model {
    three().load_with(options).unwrap()
}

/// The tags of the collider, after checking that the visual meshes have the same.
fn tags(model: &Model) -> Vec<SurfaceTag> {
    let seen = model.visual_collider().unwrap();
    assert_eq!(seen.tags(), model.rig.collider.tags());
    let primitives = model.visual.iter().flat_map(|mesh| &mesh.primitives);
    let drawn: Vec<_> = primitives
        .flat_map(|primitive| vec![primitive.tag; primitive.triangles.len()])
        .collect();
    assert_eq!(drawn, model.rig.collider.tags().to_vec());
    drawn
}

#[test]
fn extras_of_materials_tag_triangles_and_others_get_the_default() {
    let (fur, horn) = (SurfaceKind::Fur, SurfaceTag::new(SurfaceKind::Stone));
    let fur = SurfaceTag::new(fur);
    let expected = [fur, fur, horn.with_user(7), SurfaceTag::default()];
    assert_eq!(tags(&load(&LoadOptions::default())), expected);
}

#[test]
fn the_tagger_is_called_for_every_material_with_its_tag_in_the_file() {
    let options = LoadOptions::default().with_tags(|name, of_file| match name {
        Some("horn") => of_file.with_user(of_file.user + 1),
        Some(name) => panic!("no material is called {name}"),
        None => of_file.with_user(100 + of_file.kind as u32),
    });
    let fur = SurfaceTag::new(SurfaceKind::Fur);
    let fur = fur.with_user(100 + SurfaceKind::Fur as u32);
    let horn = SurfaceTag::new(SurfaceKind::Stone);
    let bare = SurfaceTag::default().with_user(100 + SurfaceKind::Skin as u32);
    let model = load(&options);
    assert_eq!(tags(&model), [fur, fur, horn.with_user(8), bare]);
    assert_eq!(model.materials[1].tag, horn.with_user(8));
}

#[test]
fn with_tag_tags_every_surface() {
    let stone = SurfaceTag::new(SurfaceKind::Stone).with_user(u32::MAX);
    let model = load(&LoadOptions::default().with_tag(stone));
    assert_eq!(tags(&model), [stone; 4]);
}

#[test]
fn marks_of_ledges_are_ignored_with_a_warning() {
    let mut file = three();
    for (material, value) in [(0, json!(1)), (1, json!(false))] {
        file.json["materials"][material]["extras"]["clamber"]["ledge"] = value;
    }
    let model = file.load_with(&LoadOptions::default()).unwrap();
    assert_eq!(tags(&model), tags(&load(&LoadOptions::default())));
    let ledges = ImportWarning::Ledges { materials: 2 };
    assert!(
        model.report.warnings.contains(&ledges),
        "{:?}",
        model.report
    );
    let other = load(&LoadOptions::default()).report.warnings;
    assert!(!other.contains(&ledges), "{other:?}");
}
