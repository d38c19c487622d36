//! The project's own giant: the properties that examples, benches and other users rely on.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::collections::HashMap;

use clamber::gltf::{LoadOptions, Model, load, load_with};
use clamber::mesh::VertexId;
use clamber::prelude::*;
use clamber_scenes::giant;
use glam::{DVec3, Vec3};

fn model() -> Model {
    load(giant::path()).unwrap()
}

/// Lowest and highest height of the skin.
fn heights(positions: &[Vec3]) -> (f32, f32) {
    let ys = || positions.iter().map(|p| p.y);
    (ys().fold(f32::MAX, f32::min), ys().fold(f32::MIN, f32::max))
}

fn positions_of(surface: &SkinnedSurface) -> Vec<Vec3> {
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    positions
}

/// Defects that keep a mesh from being a closed manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Flaws {
    /// Edges whose triangles do not pair off in opposite directions: 0 for a closed mesh.
    open_edges: usize,
    /// Edges with more than two triangles: 0 for a manifold.
    crowded_edges: usize,
}

/// Counts the flaws of a mesh.
fn flaws(mesh: &ColliderMesh) -> Flaws {
    let mut shared: HashMap<[u32; 2], (u32, i32)> = HashMap::new();
    for corners in mesh.triangles() {
        for k in 0..3 {
            let (a, b) = (corners[k].0, corners[(k + 1) % 3].0);
            let edge = shared.entry([a.min(b), a.max(b)]).or_default();
            edge.0 += 1;
            edge.1 += if a < b { 1 } else { -1 };
        }
    }
    Flaws {
        open_edges: shared.values().filter(|edge| edge.1 != 0).count(),
        crowded_edges: shared.values().filter(|edge| edge.0 > 2).count(),
    }
}

/// The volume that a closed mesh encloses at rest, in cubic units of mesh space. Negative if its triangles face
/// inwards.
fn volume(mesh: &ColliderMesh) -> f64 {
    let corner = |v: VertexId| mesh.positions()[v.index()].as_dvec3();
    let six_volumes = mesh.triangles().iter().map(|t| {
        let [a, b, c] = t.map(corner);
        a.dot(b.cross(c))
    });
    six_volumes.sum::<f64>() / 6.0
}

#[test]
fn the_file_has_the_expected_joints_meshes_clips_weak_points_and_tags() {
    let model = model();
    let joints = model.rig.skeleton.joints().len();
    assert!(joints >= 40, "{joints} joints");
    let vertices = model.rig.collider.positions().len();
    assert!((5_000..=10_000).contains(&vertices), "{vertices} vertices");
    let seen: usize = model.visual.iter().map(|seen| seen.positions.len()).sum();
    assert!(
        (50_000..=100_000).contains(&seen),
        "{seen} vertices to be seen"
    );
    for seen in &model.visual {
        assert_eq!(seen.normals.len(), seen.positions.len());
        assert_eq!(seen.tex_coords[0].len(), seen.positions.len());
    }
    let clips = model.rig.clips.iter().map(|clip| clip.name.as_str());
    let clips: Vec<&str> = clips.collect();
    for name in ["idle", "walk", "shake", "swipe", "stomp", "stagger", "die"] {
        assert!(clips.contains(&name), "{name} of {clips:?}");
    }
    assert_eq!(clips.len(), 26, "{clips:?}");
    assert_eq!(model.rig.weak_points.len(), 3);
    let points = model.rig.weak_points.iter();
    let major: Vec<_> = points.filter(|point| point.major).collect();
    assert_eq!(major.len(), 1);
    let joint = &model.rig.skeleton.joints()[major[0].joint.0 as usize];
    assert!(joint.name.to_lowercase().contains("head"), "{}", joint.name);
    let tags = model.rig.collider.tags();
    let has = |kind| tags.contains(&SurfaceTag::new(kind));
    assert!(has(SurfaceKind::Fur) && has(SurfaceKind::Stone) && has(SurfaceKind::Skin));
    let (warnings, build) = (&model.report.warnings, &model.report.build);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert!(build.worst_weight_error < 1e-5, "{build:?}");
    let (low, high) = heights(model.rig.collider.positions());
    assert!(
        (36.0..44.0).contains(&(high - low)) && low.abs() < 0.5,
        "{low} to {high}"
    );
}

#[test]
fn its_collision_mesh_is_closed_and_faces_outwards() {
    let model = model();
    assert_eq!(model.report.build.cracks, 0);
    assert_eq!(flaws(&model.rig.collider), Flaws::default());
    let volume = volume(&model.rig.collider);
    assert!(volume > 1_000.0, "{volume} m^3");
}

#[test]
fn ledges_are_level_and_wide_enough_to_stand_on() {
    let model = model();
    let mut area = 0.0;
    let mesh = &model.rig.collider;
    for triangle in &model.rig.collider_materials["stone_ledge"] {
        let corners = mesh.triangles()[triangle.index()];
        let [a, b, c] = corners.map(|v| mesh.positions()[v.index()].as_dvec3());
        let normal = (b - a).cross(c - a);
        if normal.y > 0.98 * normal.length() {
            area += normal.length() * 0.5;
        }
    }
    assert!(area > 60.0, "{area} square metres of level ledges");
}

#[test]
fn loops_close_and_no_clip_sinks_into_the_ground() {
    let model = model();
    let rest = model.rig.skeleton.rest_pose();
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    for clip in &model.rig.clips {
        let ends = [0.0, clip.duration()].map(|time| {
            let pose = clip.sample(&rest, time, Playback::Clamp).unwrap();
            model.rig.skeleton.palette(&pose).unwrap()
        });
        if ["idle", "walk", "shake"].contains(&clip.name.as_str()) {
            let mut at = |palette| {
                surface.teleport(palette, Similarity::IDENTITY).unwrap();
                positions_of(&surface)
            };
            let (first, last) = (at(&ends[0]), at(&ends[1]));
            let gap = first.iter().zip(&last).map(|(a, b)| a.distance(*b));
            let gap = gap.fold(0.0, f32::max);
            assert!(gap < 1e-3, "{}: {gap} m between its ends", clip.name);
        }
        for k in 0..20 {
            let time = clip.duration() * f64::from(k) / 20.0;
            let pose = clip.sample(&rest, time, Playback::Clamp).unwrap();
            let palette = model.rig.skeleton.palette(&pose).unwrap();
            surface.advance(&palette, Similarity::IDENTITY).unwrap();
            let (low, high) = heights(&positions_of(&surface));
            let told = format!("{} at {time:.2} s: {low} to {high} m", clip.name);
            assert!(low > -0.75, "{told}");
            assert!(low < 0.75 && high < 48.0, "{told}");
        }
    }
}

#[test]
fn its_feet_do_not_slide_when_it_walks_at_its_speed() {
    let giant = giant::giant().unwrap();
    let walk = giant.clip_like(&["walk"]).unwrap();
    let speed = giant.walk_speed.unwrap();
    let rest = giant.rig.skeleton.rest_pose();
    let mut surface = SkinnedSurface::new(giant.rig.collider.clone());
    let dt = 1.0 / 60.0;
    let ticks = (walk.duration() / dt) as u32;
    let mut slides = Vec::new();
    for tick in 0..ticks {
        let time = f64::from(tick) * dt;
        let pose = walk.sample(&rest, time, Playback::Loop).unwrap();
        let forward = Similarity::from_translation(DVec3::Z * (speed * time));
        surface
            .advance(&giant.rig.skeleton.palette(&pose).unwrap(), forward)
            .unwrap();
        if tick == 0 {
            continue;
        }
        // The lowest point is on a standing foot.
        let positions = positions_of(&surface);
        let lowest =
            (0..positions.len()).min_by(|a, b| positions[*a].y.total_cmp(&positions[*b].y));
        let vertex = VertexId(lowest.unwrap() as u32);
        let before = surface.in_model().previous_position(vertex).unwrap();
        let moved = positions[vertex.index()] - before;
        slides.push(moved.with_y(0.0).length() / dt as f32);
    }
    slides.sort_by(f32::total_cmp);
    let median = slides[slides.len() / 2];
    println!("soles slide at {median:.3} m/s in the median while it walks at {speed} m/s");
    // The joints of the feet do not slide. The skin of the soles rolls, and follows the shins a little.
    assert!(
        f64::from(median) < speed / 10.0,
        "soles slide at {median} m/s"
    );
}

#[test]
fn it_can_be_made_with_any_number_of_vertices() {
    let whole = volume(&model().rig.collider);
    for vertices in [3_000, 20_000, 100_000] {
        let mesh = giant::giant_of(vertices).unwrap().rig.collider;
        let found = mesh.positions().len();
        assert!(
            found <= vertices && found * 1000 >= vertices * 999,
            "{found} of {vertices}"
        );
        assert_eq!(flaws(&mesh), Flaws::default(), "{vertices}");
        let change = volume(&mesh) / whole - 1.0;
        assert!(
            change.abs() < 0.02,
            "{vertices}: volume changes by {change}"
        );
    }
}

/// Skinned vertices of the giant at rest, and in the middle of its walk.
fn skinned(model: &Model) -> [Vec<Vec3>; 2] {
    let rest = model.rig.skeleton.rest_pose();
    let walk = model.rig.clip("walk").unwrap();
    let stride = walk.sample(&rest, 0.4 * walk.duration(), Playback::Loop);
    [rest, stride.unwrap()].map(|pose| {
        let palette = model.rig.skeleton.palette(&pose).unwrap();
        clamber::skin::skin(&model.rig.collider, palette.matrices()).unwrap()
    })
}

#[test]
fn it_can_be_loaded_at_any_height() {
    let own = model();
    for wanted in [1.8, 250.0f32] {
        let options = LoadOptions::default().with_height(wanted);
        let scaled = load_with(giant::path(), &options).unwrap();
        let factor = scaled.report.scale.unwrap();
        let (low, high) = heights(&skinned(&scaled)[0]);
        let off = ((high - low) / wanted - 1.0).abs();
        assert!(off < 1e-4, "{} m in place of {wanted} m", high - low);
        for (own, scaled) in skinned(&own).iter().zip(skinned(&scaled)) {
            assert_eq!(own.len(), scaled.len());
            for (own, scaled) in own.iter().zip(scaled) {
                let off = (own.as_dvec3() * factor - scaled.as_dvec3()).length();
                assert!(off < 2e-6 * f64::from(wanted), "{own} became {scaled}");
            }
        }
        for (own, scaled) in own.rig.weak_points.iter().zip(&scaled.rig.weak_points) {
            let radius = f64::from(own.radius) * factor;
            assert!((radius - f64::from(scaled.radius)).abs() < 1e-6 * radius);
        }
        assert_eq!(scaled.report.build.welded, own.report.build.welded);
    }
}
