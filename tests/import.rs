//! Real models through the importer.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::path::Path;
use std::sync::{Arc, Mutex};

use clamber::geometry::Ray;
use clamber::gltf::{GltfErrorKind, LoadOptions, Model, load, load_slice, load_with};
use clamber::prelude::*;
use clamber_scenes::test_data;
use glam::{DVec3, Vec3};

/// Files of the test data that the importer refuses: the beginning of the path, and the end of the path with the error.
#[rustfmt::skip]
const REFUSED: [(&str, &str); 13] = [
    // These have points and lines only.
    (PRIMITIVE_MODE, "00.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "01.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "02.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "03.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "07.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "08.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "09.gltf: no mesh with triangles for collision in a file without skins"),
    (PRIMITIVE_MODE, "10.gltf: no mesh with triangles for collision in a file without skins"),
    // These have points only.
    ("fixtures/KhronosGroup+glTF-Validator/joints_no_weights", ".gltf: no mesh with triangles for collision in skin 0"),
    ("fixtures/KhronosGroup+glTF-Validator/joints_weights_complex", ".gltf: no mesh with triangles for collision in skins 0, 1"),
    // All corners of its triangles are at one point.
    ("fixtures/mosra+magnum-plugins/skin-shared", ".gltf: the meshes of skins 0, 1 make no collider: no usable triangle"),
    // Exported with weights of 0 / 0.
    ("models/Crab", ".glb: mesh 0, primitive 0: weights [NaN, NaN, NaN, NaN] of vertex 1223"),
    ("models/Wasp", ".glb: mesh 0, primitive 0: weights [NaN, NaN, NaN, NaN] of vertex 2240"),
];

/// Beginning of the paths of fixtures with one mode of primitives each.
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
            (Ok(model), None) => pose_in_every_clip(name, &model),
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

fn pose_in_every_clip(name: &str, model: &Model) {
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    let rest = model.rig.skeleton.rest_pose();
    let mut positions = Vec::new();
    let middle = |clip: &Clip| {
        clip.sample(&rest, clip.duration() * 0.5, Playback::Loop)
            .unwrap()
    };
    for pose in std::iter::once(rest.clone()).chain(model.rig.clips.iter().map(middle)) {
        let palette = model.rig.skeleton.palette(&pose).unwrap();
        surface.advance(&palette, Similarity::IDENTITY).unwrap();
        surface.skin_all(&mut positions);
        assert!(positions.iter().all(|p| p.is_finite()), "{name}");
    }
    for seen in &model.visual {
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
fn fixtures_show_the_features_that_they_are_made_for() {
    let Some(first) = test_data::file("fixtures", "models/Trex.glb") else {
        return;
    };
    let fixtures = first.ancestors().nth(2).unwrap().join("fixtures");
    // Eight files with triangle strips, fans and lists, with and without indices: each is a square of area 1.
    for number in [4, 5, 6, 11, 12, 13, 14, 15] {
        let name = format!(
            "AssetGenerator-0.6/BabylonJS+MeshesLibrary/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{number:02}.gltf"
        );
        let model = load(fixtures.join(&name)).unwrap();
        let area: f64 = areas(&model).sum();
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
    assert_eq!(sparse.rig.collider.triangles().len(), 12);
    // Some of its nodes mirror.
    let mirrored = load(fixtures.join("unavi-xyz+gltf_kun/NegativeScaleTest.glb")).unwrap();
    let palette = rest_palette(&mirrored);
    assert!(palette.matrices().iter().any(|m| m.is_mirrored()));
}

fn rest_palette(model: &Model) -> Palette {
    let skeleton = &model.rig.skeleton;
    skeleton.palette(&skeleton.rest_pose()).unwrap()
}

/// Areas of a rig's triangles at rest.
fn areas(model: &Model) -> impl Iterator<Item = f64> {
    let positions = model.rig.collider.positions();
    model.rig.collider.triangles().iter().map(|corners| {
        let [a, b, c] = corners.map(|v| positions[v.index()].as_dvec3());
        (b - a).cross(c - a).length() * 0.5
    })
}

#[test]
fn at_rest_a_man_stands_upright() {
    // The mesh lies on its back; the node above the skeleton raises it.
    let Some(path) = test_data::file("bind pose", "models/CesiumMan.glb") else {
        return;
    };
    let model = load(&path).unwrap();
    let palette = rest_palette(&model);
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    surface.teleport(&palette, Similarity::IDENTITY).unwrap();
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
    let names = Arc::new(Mutex::new(Vec::new()));
    let seen = names.clone();
    let options = LoadOptions::default().with_tags(move |name, _| {
        seen.lock().unwrap().push(name.map(str::to_owned));
        fur
    });
    let model = load_with(&path, &options).unwrap();
    // The function is called for each material, then for triangles without a material.
    let names = names.lock().unwrap();
    let mut expected: Vec<_> = model.materials.iter().map(|m| m.name.clone()).collect();
    assert!(!expected.is_empty());
    expected.push(None);
    assert_eq!(*names, expected);
    assert!(model.rig.collider.tags().iter().all(|tag| *tag == fur));
}

#[test]
fn errors_of_bad_files_name_the_cause() {
    let missing = load(Path::new("no/such/file.glb")).unwrap_err();
    assert!(
        missing.to_string().contains("no/such/file.glb"),
        "{missing}"
    );
    let options = LoadOptions::default();
    for (bytes, text) in [
        (&b"hello"[..], "neither GLB nor glTF"),
        (b"", "the file is empty"),
        (b"glTF\x02\0\0\0", "ends after 8 of 12 bytes"),
    ] {
        let error = load_slice(bytes, &options).unwrap_err();
        assert_eq!(error.to_string(), text);
    }
    let Some(path) = test_data::file("truncated files", "models/RiggedSimple.glb") else {
        return;
    };
    let bytes = std::fs::read(&path).unwrap();
    for cut in (12..bytes.len()).step_by(61) {
        let error = load_slice(&bytes[..cut], &options).unwrap_err();
        let text = format!("ends after {cut} of {} bytes", bytes.len());
        assert_eq!(error.to_string(), text);
    }
    assert!(load_slice(&bytes, &options).is_ok());
    let second = options.with_skin(1);
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

/// A document of two triangles, one above the other. The extras of the upper triangle's material have the user
/// number 7.
fn two_triangles() -> String {
    let corners = |y: f32| [[0.0, y, 0.0], [0.0, y, 1.0], [1.0, y, 0.0]];
    let floats = corners(1.0).into_iter().chain(corners(0.0)).flatten();
    let data: String = floats
        .flat_map(f32::to_le_bytes)
        .map(|byte| format!("%{byte:02x}"))
        .collect();
    let triangle = |offset: usize| {
        format!(
            r#"{{"bufferView": 0, "byteOffset": {offset}, "componentType": 5126, "count": 3, "type": "VEC3"}}"#
        )
    };
    let (upper, lower) = (triangle(0), triangle(36));
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
        "materials": [{{"name": "pelt", "extras": {{"clamber": {{"surface": "fur", "user": 7}}}}}}],
        "meshes": [{{"primitives": [
            {{"attributes": {{"POSITION": 0}}, "material": 0}}, {{"attributes": {{"POSITION": 1}}}}]}}],
        "accessors": [{upper}, {lower}],
        "bufferViews": [{{"buffer": 0, "byteLength": 72}}],
        "buffers": [{{"byteLength": 72, "uri": "data:,{data}"}}]}}"#
    )
}

/// The user numbers of hits from above and from below. Asserts that rays of the surface and of the obstacle find the
/// same.
fn users_found(options: &LoadOptions) -> [u32; 2] {
    let model = load_slice(two_triangles().as_bytes(), options).unwrap();
    let palette = rest_palette(&model);
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    surface.advance(&palette, Similarity::IDENTITY).unwrap();
    [(2.0, -1.0), (-1.0, 1.0)].map(|(y, down)| {
        let origin = Vec3::new(0.25, y, 0.25);
        let ray = Ray::new(origin, Vec3::Y * down).unwrap();
        let hit = surface.in_model().cast_ray(&ray, 10.0).unwrap();
        let (origin, direction) = (origin.as_dvec3(), DVec3::Y * f64::from(down));
        let contact = surface.cast_ray(origin, direction, 10.0).unwrap();
        assert_eq!(contact.tag, hit.tag);
        hit.tag.user
    })
}

#[test]
fn the_games_own_number_reaches_hits_and_contacts() {
    assert_eq!(users_found(&LoadOptions::default()), [7, 0]);
    let tagged = LoadOptions::default().with_tags(|name, of_file| match name {
        Some("pelt") => of_file.with_user(of_file.user << 24),
        _ => of_file.with_user(9),
    });
    assert_eq!(users_found(&tagged), [7 << 24, 9]);
}
