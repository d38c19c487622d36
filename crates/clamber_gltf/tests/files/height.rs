//! Creatures that are scaled to a height.

use clamber_gltf::{GltfErrorKind, LoadOptions, Model};
use clamber_surface::rig::Playback;
use glam::Vec3;
use serde_json::json;

use crate::builder::File;

/// The square, 2 m tall in its armature of scale 2, with a weak point. A clip translates it with every interpolation.
fn moving_square() -> File {
    let mut file = File::square();
    // The creature stands apart from its bind pose, whose inverse matrices have a translation.
    file.json["nodes"][0]["translation"] = json!([0.5, -3, 0]);
    let weak = json!({"name": "eye", "translation": [0, 0.25, 0.5],
        "extras": {"clamber": {"weak_point": {"hit_points": 1, "radius": 0.3}}}});
    file.node_under(2, weak);
    let times = file.floats("SCALAR", &[0.0, 1.0]);
    let two = file.floats("VEC3", &[0.0, 1.0, 0.0, 0.3, 1.5, 0.1]);
    #[rustfmt::skip]
    let spline = file.floats("VEC3", &[
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0,
        0.0, 7.0, 0.0, 0.1, 0.2, 0.3, 0.0, 0.0, 0.0,
    ]);
    let sizes = file.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 0.5, 3.0]);
    let animation = &mut file.json["animations"][0];
    for (sampler, output, interpolation, node, path) in [
        (1, two, "LINEAR", 2, "translation"),
        (2, two, "STEP", 0, "translation"),
        (3, spline, "CUBICSPLINE", 1, "translation"),
        (4, sizes, "LINEAR", 1, "scale"),
    ] {
        let samplers = animation["samplers"].as_array_mut().unwrap();
        samplers.push(json!({"input": times, "output": output, "interpolation": interpolation}));
        let channels = animation["channels"].as_array_mut().unwrap();
        channels.push(json!({"sampler": sampler, "target": {"node": node, "path": path}}));
    }
    file
}

fn with_height(file: &File, height: f32) -> Result<Model, GltfErrorKind> {
    file.load_with(&LoadOptions::default().with_height(height))
}

/// All vertices at a time of the first clip, or at rest.
fn skinned(model: &Model, time: Option<f64>) -> Vec<Vec3> {
    let rest = model.rig.skeleton.rest_pose();
    let pose = match time {
        Some(time) => model.rig.clips[0]
            .sample(&rest, time, Playback::Clamp)
            .unwrap(),
        None => rest,
    };
    let palette = model.rig.skeleton.palette(&pose).unwrap();
    clamber_surface::skin::skin(&model.rig.collider, palette.matrices()).unwrap()
}

#[test]
fn scaling_multiplies_every_length() {
    let file = moving_square();
    let (plain, scaled) = (file.load().unwrap(), with_height(&file, 5.0).unwrap());
    assert_eq!(plain.report.scale, None);
    assert_eq!(scaled.report.scale, Some(2.5));
    for time in [None, Some(0.0), Some(0.3), Some(0.8), Some(1.0)] {
        for (plain, scaled) in skinned(&plain, time).iter().zip(skinned(&scaled, time)) {
            let off = (*plain * 2.5 - scaled).length();
            assert!(off < 1e-5, "{time:?}: {plain} became {scaled}");
        }
    }
    let ys = || skinned(&scaled, None).into_iter().map(|p| p.y);
    let height = ys().fold(f32::MIN, f32::max) - ys().fold(f32::MAX, f32::min);
    assert!((height - 5.0).abs() < 1e-5, "{height}");
    assert_eq!(scaled.visual[0].positions[2], Vec3::new(2.5, 2.5, 0.0));
    let (eye, plain_eye) = (&scaled.rig.weak_points[0], &plain.rig.weak_points[0]);
    assert_eq!(eye.position, plain_eye.position * 2.5);
    assert_eq!(eye.radius, 0.3 * 2.5);
    assert_eq!(
        scaled.rig.skeleton.joints()[1].inverse_bind.rows[1][3],
        -2.5
    );
    assert_eq!(
        scaled.rig.collider.radius(),
        plain.rig.collider.radius() * 2.5
    );
}

#[test]
fn bad_heights_and_creatures_without_height_are_refused() {
    let file = File::square();
    for wanted in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let error = with_height(&file, wanted).unwrap_err();
        assert!(matches!(error, GltfErrorKind::BadHeight { .. }), "{error}");
    }
    // The square lies down and is flat.
    let mut flat = File::square();
    flat.json["nodes"][0]["rotation"] = json!([1, 0, 0, 0]);
    flat.json["nodes"][0]["scale"] = json!([2, 0, 2]);
    let error = with_height(&flat, 1.0).unwrap_err();
    let expected = matches!(error, GltfErrorKind::NoHeight { found, .. } if found == 0.0);
    assert!(expected, "{error}");
    // At that height the joints are farther away than f32 can express.
    let mut far = File::square();
    far.json["nodes"][0]["scale"] = json!([1e-20, 1e-20, 1e-20]);
    far.json["nodes"][0]["translation"] = json!([1e20, 0, 0]);
    let error = with_height(&far, 1e10).unwrap_err();
    assert!(!error.to_string().is_empty(), "{error}");
}
