//! Real models through the importer.

use std::path::Path;

use clamber::gltf::{GltfError, LoadOptions, load, load_slice, load_with};
use clamber::prelude::*;
use clamber_scenes::test_data;

/// Models of the test data that the importer refuses, and why.
const REFUSED: [(&str, &str); 2] = [
    ("Crab.glb", "weights that are not a number"),
    ("Wasp.glb", "weights that are not a number"),
];

#[test]
fn every_model_loads_and_moves_or_is_refused_for_a_known_reason() {
    let Some(known) = test_data::file("import of all models", "models/Trex.glb") else {
        return;
    };
    let mut loaded = 0;
    for entry in std::fs::read_dir(known.parent().unwrap()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if !name.ends_with(".glb") && !name.ends_with(".gltf") {
            continue;
        }
        if REFUSED.iter().any(|(refused, _)| *refused == name) {
            let error = load(&path).unwrap_err();
            assert!(
                matches!(error, GltfError::Collider { .. }),
                "{name}: {error}"
            );
            continue;
        }
        let rig = load(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!rig.clips.is_empty(), "{name}");
        let mut surface = SkinnedSurface::new(rig.collider.clone());
        for clip in &rig.clips {
            let half = clip.duration() * 0.5;
            let pose = clip
                .sample(&rig.skeleton.rest_pose(), half, Playback::Loop)
                .unwrap();
            let palette = rig.skeleton.palette(&pose).unwrap();
            surface.advance(&palette, Similarity::IDENTITY).unwrap();
        }
        loaded += 1;
    }
    assert_eq!(loaded + REFUSED.len(), 29);
}

#[test]
fn at_rest_the_palette_leaves_the_bind_pose_where_it_is() {
    // CesiumMan's rest pose is its bind pose, but for the turn of the node above the skeleton.
    let Some(path) = test_data::file("bind pose", "models/CesiumMan.glb") else {
        return;
    };
    let rig = load(&path).unwrap();
    let palette = rig.skeleton.palette(&rig.skeleton.rest_pose()).unwrap();
    let mut surface = SkinnedSurface::new(rig.collider.clone());
    surface.place(&palette, Similarity::IDENTITY).unwrap();
    let (low, high) = surface
        .positions()
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
    let fur = SurfaceTag {
        kind: SurfaceKind::Fur,
        ledge: false,
    };
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
        load_slice(b"hello", &options),
        Err(GltfError::Format(_))
    ));
    assert!(matches!(
        load_slice(b"", &options),
        Err(GltfError::Format(_))
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
            error,
            GltfError::NoSuchSkin {
                wanted: 1,
                found: 1
            }
        ),
        "{error}"
    );
}
