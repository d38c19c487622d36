//! Real models through the importer.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::path::Path;

use clamber::gltf::{GltfErrorKind, LoadOptions, Rig, load, load_slice, load_with};
use clamber::prelude::*;
use clamber_scenes::inspect::{InspectOptions, inspect};
use clamber_scenes::test_data;

/// Files of the test data that the importer refuses: where, and why.
#[rustfmt::skip]
const REFUSED: [(&str, &str); 13] = [
    // Points and lines.
    (PRIMITIVE_MODE, "00.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "01.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "02.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "03.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "07.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "08.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "09.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "10.gltf: no mesh with triangles for collision in a file without skins"),
    // Points once more.
    ("fixtures/KhronosGroup+glTF-Validator/joints_no_weights", ".gltf: no mesh with triangles for collision in skin 0"),
    ("fixtures/KhronosGroup+glTF-Validator/joints_weights_complex", ".gltf: no mesh with triangles for collision in skins 0, 1"),
    // Its triangles have all corners in one place.
    ("fixtures/mosra+magnum-plugins/skin-shared", ".gltf: the meshes of skins 0, 1 make no collider: no usable triangle"),
    // Exported with weights of 0 / 0.
    ("models/Crab", ".glb: mesh 0, primitive 0: weights [NaN, NaN, NaN, NaN] of vertex 1223"),
    ("models/Wasp", ".glb: mesh 0, primitive 0: weights [NaN, NaN, NaN, NaN] of vertex 2240"),
];

const PRIMITIVE_MODE: &str =
    "fixtures/AssetGenerator-0.6/BabylonJS+MeshesLibrary/Mesh_PrimitiveMode/Mesh_PrimitiveMode_";

#[test]
fn every_file_loads_and_moves_or_is_refused_for_a_known_reason() {
    let files = test_data::gltf_files("import of all files").unwrap();
    let mut refused = 0;
    for (name, path) in &files {
        let known = |(place, reason): &(&str, &str)| {
            let file = reason.split_once(": ").map_or("", |(rest, _)| rest);
            (*name == format!("{place}{file}")).then(|| format!("{place}{reason}"))
        };
        match (load(path), REFUSED.iter().find_map(known)) {
            (Ok(rig), None) => pose_in_every_clip(name, &rig),
            (Err(error), Some(expected)) => {
                let error = error.to_string();
                assert!(error.contains(&expected), "{error}\nexpected {expected}");
                refused += 1;
            }
            (Ok(_), Some(expected)) => panic!("{name} loads, but expected {expected}"),
            (Err(error), None) => panic!("{error}"),
        }
    }
    if !files.is_empty() {
        assert_eq!((files.len(), refused), (29 + 76, REFUSED.len()));
    }
}

fn pose_in_every_clip(name: &str, rig: &Rig) {
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    let rest = rig.skeleton.rest_pose();
    let mut positions = Vec::new();
    let middle = |clip: &Clip| {
        clip.sample(&rest, clip.duration() * 0.5, Playback::Loop)
            .unwrap()
    };
    for pose in std::iter::once(rest.clone()).chain(rig.clips.iter().map(middle)) {
        let palette = rig.skeleton.palette(&pose).unwrap();
        surface.advance(&palette, Similarity::IDENTITY).unwrap();
        surface.skin_all(&mut positions);
        assert!(positions.iter().all(|p| p.is_finite()), "{name}");
    }
    for seen in &rig.visual {
        let vertices = seen.positions.len();
        assert_eq!(seen.influence_ends.len(), vertices, "{name}, {}", seen.name);
        let corners = seen
            .primitives
            .iter()
            .flat_map(|p| p.triangles.as_flattened());
        assert!(
            corners.into_iter().all(|v| (*v as usize) < vertices),
            "{name}"
        );
    }
}

#[test]
fn everything_promised_of_a_creature_holds_for_every_model() {
    let files = test_data::gltf_files("inspection of all models").unwrap();
    let mut inspected = 0;
    for (name, path) in files.iter().filter(|(name, _)| name.starts_with("models/")) {
        let Ok(rig) = load(path) else {
            continue;
        };
        let options = InspectOptions {
            poses: 1,
            ..InspectOptions::of(path.clone())
        };
        let inspection = inspect(&rig, &options).unwrap();
        assert!(inspection.holds(), "{name}\n{inspection}");
        assert!(inspection.query_hits > 0, "{name}\n{inspection}");
        inspected += 1;
    }
    assert!(files.is_empty() || inspected == 27, "{inspected}");
}

#[test]
fn what_fixtures_are_made_to_show() {
    let Some(first) = test_data::file("fixtures", "models/Trex.glb") else {
        return;
    };
    let fixtures = first.ancestors().nth(2).unwrap().join("fixtures");
    // Four triangle strips, fans and lists, with and without indices: one square each.
    for number in [4, 5, 6, 11, 12, 13, 14, 15] {
        let name = format!(
            "AssetGenerator-0.6/BabylonJS+MeshesLibrary/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{number:02}.gltf"
        );
        let rig = load(fixtures.join(&name)).unwrap();
        let area: f64 = areas(&rig).sum();
        assert!((area - 1.0).abs() < 1e-6, "{name}: {area}");
    }
    // Two sets of weights, and sparse positions.
    let sets = load(fixtures.join("mosra+magnum-plugins/skin-multiple-sets.gltf")).unwrap();
    assert!(
        sets.report.build.max_influences > 4,
        "{:?}",
        sets.report.build
    );
    let sparse = load(fixtures.join("gltf-rs+gltf/box_sparse.glb")).unwrap();
    assert_eq!(sparse.collider.triangles().len(), 12);
    // Some of its nodes mirror.
    let mirrored = load(fixtures.join("unavi-xyz+gltf_kun/NegativeScaleTest.glb")).unwrap();
    let palette = mirrored
        .skeleton
        .palette(&mirrored.skeleton.rest_pose())
        .unwrap();
    let flipped = palette
        .matrices()
        .iter()
        .filter(|m| m.is_mirrored())
        .count();
    assert!(flipped > 0);
}

/// Areas of a rig's triangles at rest.
fn areas(rig: &Rig) -> impl Iterator<Item = f64> {
    let positions = rig.collider.positions();
    rig.collider.triangles().iter().map(|corners| {
        let [a, b, c] = corners.map(|v| positions[v.index()].as_dvec3());
        (b - a).cross(c - a).length() * 0.5
    })
}

#[test]
fn at_rest_a_man_stands_upright() {
    // His mesh lies on its back; the node above the skeleton raises it.
    let Some(path) = test_data::file("bind pose", "models/CesiumMan.glb") else {
        return;
    };
    let rig = load(&path).unwrap();
    let palette = rig.skeleton.palette(&rig.skeleton.rest_pose()).unwrap();
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    surface.place(&palette, Similarity::IDENTITY).unwrap();
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let (low, high) = positions
        .iter()
        .fold((f32::MAX, f32::MIN), |(low, high), p| {
            (low.min(p.y), high.max(p.y))
        });
    assert!(
        (high - low - 1.5).abs() < 0.1,
        "stands {} m tall, Y up",
        high - low
    );
}

#[test]
fn materials_are_tagged_by_the_callers_function() {
    let Some(path) = test_data::file("tags by material", "models/Trex.glb") else {
        return;
    };
    let fur = SurfaceTag::new(SurfaceKind::Fur);
    let names = std::cell::RefCell::new(Vec::new());
    let tag = |name: &str| {
        names.borrow_mut().push(name.to_owned());
        Some(fur)
    };
    let options = LoadOptions {
        tag_of_material: Some(&tag),
        ..LoadOptions::default()
    };
    let rig = load_with(&path, &options).unwrap();
    assert!(!names.borrow().is_empty());
    assert!(rig.collider.tags().iter().all(|tag| *tag == fur));
}

#[test]
fn bad_files_say_what_is_wrong() {
    let missing = load(Path::new("no/such/file.glb")).unwrap_err();
    assert!(
        missing.to_string().contains("no/such/file.glb"),
        "{missing}"
    );
    let options = LoadOptions::default();
    assert!(matches!(
        load_slice(b"hello", &options).map_err(|error| error.kind),
        Err(GltfErrorKind::Format(_))
    ));
    assert!(matches!(
        load_slice(b"", &options).map_err(|error| error.kind),
        Err(GltfErrorKind::Format(_))
    ));
    let Some(path) = test_data::file("truncated files", "models/RiggedSimple.glb") else {
        return;
    };
    let bytes = std::fs::read(&path).unwrap();
    for cut in (0..bytes.len()).step_by(61) {
        assert!(load_slice(&bytes[..cut], &options).is_err(), "cut at {cut}");
    }
    assert!(load_slice(&bytes, &options).is_ok());
    let second = LoadOptions {
        skin: Some(1),
        ..options
    };
    let error = load_slice(&bytes, &second).unwrap_err();
    assert!(
        matches!(
            error.kind,
            GltfErrorKind::NoSuchSkin {
                wanted: 1,
                found: 1
            }
        ),
        "{error}"
    );
}
