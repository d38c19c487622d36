//! The fuzz target of imports: any file is rejected with a reason, or gives a rig that can be used.

use crate::agreement::{Comparison, Question, Shape};
use clamber_gltf::{LoadOptions, Model, load_slice};
use clamber_surface::geometry::Similarity;
use clamber_surface::measure::BruteForce;
use clamber_surface::rig::Playback;
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;

use super::seed::glb;

/// Loads any bytes as a file, and uses the model; returns true if the file loads.
///
/// Bytes that contain a zero and do not begin as a GLB are wrapped as the two chunks of a GLB: JSON before the first
/// zero, binary after it. So a fuzzer does not have to get any length right.
///
/// # Panics
/// If the rig breaks a promise of the library.
pub fn import(data: &[u8]) -> bool {
    let end = data.iter().position(|byte| *byte == 0);
    let wrapped = match end {
        Some(end) if !data.starts_with(b"glTF") => Some(glb(&data[..end], &data[end + 1..])),
        _ => None,
    };
    match load_slice(wrapped.as_deref().unwrap_or(data), &LoadOptions::default()) {
        Ok(model) => {
            use_rig(&model);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// Poses and queries a rig as a user would.
fn use_rig(model: &Model) {
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    let rest = model.rig.skeleton.rest_pose();
    let mut poses = vec![rest.clone()];
    for clip in model.rig.clips.iter().take(4) {
        for (share, playback) in [(0.3, Playback::Loop), (1.5, Playback::Clamp)] {
            poses.extend(clip.sample(&rest, clip.duration() * share, playback));
        }
    }
    let mut positions = Vec::new();
    for pose in &poses {
        // A valid file may have poses beyond the library's limits. The library rejects them with an error.
        let Ok(palette) = model.rig.skeleton.palette(pose) else {
            continue;
        };
        if surface.advance(&palette, Similarity::IDENTITY).is_err() {
            continue;
        }
        surface.skin_all(&mut positions);
        assert!(positions.iter().all(|p| p.is_finite()), "{positions:?}");
    }
    // Brute force takes long on a large file.
    if model.rig.collider.triangles().len() < 1_000 {
        compare(&surface);
    }
    for weak_point in &model.rig.weak_points {
        assert!((weak_point.joint.0 as usize) < model.rig.skeleton.joints().len());
    }
    let _ = model.visual_collider();
}

/// Compares an overlap query around a vertex with brute force.
fn compare(surface: &SkinnedSurface) {
    let mesh = surface.mesh();
    let center = mesh.positions().first().copied().unwrap_or(Vec3::ZERO);
    let radius = mesh.radius() * 0.5;
    let shape = Shape::ball(center, radius);
    let mut comparison = Comparison::default();
    let space = surface.in_model();
    comparison.ask(&BruteForce::new(space), &Question::OverlapCapsule { shape });
    if let Err(disagreement) = comparison.hold(&space) {
        panic!("{disagreement}");
    }
}
