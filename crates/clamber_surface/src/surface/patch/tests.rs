use glam::{DVec3, Vec3};

use super::{Patch, PatchChange};
use crate::geometry::{Similarity, rotation_from_axis_angle};
use crate::measure::BruteForce;
use crate::mesh::TriangleId;
use crate::surface::SkinnedSurface;
use crate::testing::{bend, point, tube};

/// A tube that bends a little more each tick, under a root that turns and climbs.
fn posed(tick: u32) -> SkinnedSurface {
    let mut surface = SkinnedSurface::new(tube(6, 12));
    advance(&mut surface, tick);
    advance(&mut surface, tick + 1);
    surface
}

fn advance(surface: &mut SkinnedSurface, tick: u32) {
    let time = f64::from(tick) / 60.0;
    let root = Similarity {
        rotation: rotation_from_axis_angle(DVec3::Y, time),
        scale: 2.0,
        translation: DVec3::new(1e5, time * 3.0, -7.0),
    };
    surface.advance(&bend(6, DVec3::Z, time), root).unwrap();
}

fn near(surface: &SkinnedSurface, low: Vec3, high: Vec3) -> Vec<TriangleId> {
    let mut ids = Vec::new();
    let all = BruteForce::new(surface.in_model());
    all.visit_box(low, high, |moving| ids.push(moving.triangle));
    ids
}

/// Asserts that a patch has the positions of both poses.
fn assert_positions(patch: &Patch, surface: &SkinnedSurface, tick: u32) {
    let space = surface.in_model();
    let own = patch.positions().iter().zip(patch.previous_positions());
    for (vertex, (now, before)) in patch.vertices().iter().zip(own) {
        let found = (Some(*now), Some(*before));
        let wanted = (space.position(*vertex), space.previous_position(*vertex));
        assert_eq!(found, wanted, "{tick} {vertex}");
    }
}

#[test]
fn a_patch_has_the_triangles_of_brute_force_with_positions_of_both_poses() {
    let mut rng = fastrand::Rng::with_seed(3);
    let mut patch = Patch::default();
    let (mut filled, mut moved) = (0, 0);
    for tick in 0..200 {
        let surface = posed(tick / 4);
        let corner = surface.mesh().triangles()[tick as usize][0];
        let center = surface.in_model().position(corner).unwrap();
        let half = Vec3::splat(0.05) + point(&mut rng, 0.3).abs();
        let (low, high) = (center - half, center + half);
        let wanted = near(&surface, low, high);
        let change = patch.update(&surface, low, high, 0.0);
        moved += usize::from(change == PatchChange::Moved);
        assert_eq!(patch.triangles(), wanted, "{tick}: {low} {high}");
        filled += wanted.len();
        for (triangle, corners) in patch.triangles().iter().zip(patch.indices()) {
            let corners = corners.map(|corner| patch.vertices()[corner as usize]);
            let wanted = surface.mesh().triangles()[triangle.index()];
            assert_eq!(corners, wanted, "{tick}");
        }
        assert_positions(&patch, &surface, tick);
    }
    assert!(filled > 1000 && moved < 200, "{filled} {moved}");
}

#[test]
fn a_patch_is_rebuilt_less_often_with_a_margin() {
    let mut surface = posed(0);
    let mut patch = Patch::default();
    let (mut rebuilt, mut exact_rebuilt) = (0, 0);
    let mut exact = Patch::default();
    for tick in 2..80 {
        advance(&mut surface, tick);
        // The box slides along the tube, half a millimetre to 2 cm a tick.
        let center = Vec3::new(1.0 + tick as f32 * 0.01, 0.5, 0.0);
        let (low, high) = (center - 0.2, center + 0.2);
        let change = patch.update(&surface, low, high, 0.1);
        rebuilt += u32::from(change == PatchChange::Rebuilt);
        let change = exact.update(&surface, low, high, 0.0);
        exact_rebuilt += u32::from(change == PatchChange::Rebuilt);
        for triangle in near(&surface, low, high) {
            assert!(patch.triangles().contains(&triangle), "{tick}: {triangle}");
        }
        assert_positions(&patch, &surface, tick);
    }
    assert!(
        rebuilt < exact_rebuilt && rebuilt > 0,
        "{rebuilt} {exact_rebuilt}"
    );
}

#[test]
fn velocities_include_the_motion_of_the_root() {
    let mut surface = SkinnedSurface::new(tube(4, 8));
    let palette = bend(4, DVec3::Z, 0.3);
    let root = |x: f64| Similarity {
        rotation: rotation_from_axis_angle(DVec3::Y, 0.5),
        scale: 2.0,
        translation: DVec3::new(x, 0.0, 1e4),
    };
    surface.advance(&palette, root(0.0)).unwrap();
    surface.advance(&palette, root(0.5)).unwrap();
    let mut patch = Patch::default();
    patch.update(&surface, Vec3::splat(-9.0), Vec3::splat(9.0), 0.0);
    assert_eq!(patch.triangles().len(), surface.mesh().triangles().len());
    let dt = 0.1;
    for velocity in patch.velocities(dt) {
        let in_world = surface
            .world_from_model()
            .transform_vector(velocity.as_dvec3());
        let off = (in_world - DVec3::X * 5.0).length();
        assert!(off < 1e-4, "{in_world}");
    }
}

#[test]
fn hidden_and_removed_triangles_leave_the_patch() {
    let mut surface = SkinnedSurface::new(tube(4, 8));
    let mut patch = Patch::default();
    let mut update = |surface: &SkinnedSurface| {
        let change = patch.update(surface, Vec3::splat(-9.0), Vec3::splat(9.0), 1.0);
        (change, patch.triangles().len())
    };
    let (_, all) = update(&surface);
    surface.disable_triangle(TriangleId(5)).unwrap();
    assert_eq!(update(&surface), (PatchChange::Rebuilt, all - 1));
    let removed = surface.edit(|edit| edit.remove_triangle(TriangleId(7)));
    assert_eq!(removed, Ok(()));
    assert_eq!(update(&surface), (PatchChange::Rebuilt, all - 2));
    assert_eq!(update(&surface), (PatchChange::Same, all - 2));
}

#[test]
fn same_is_reported_only_if_no_position_changed_in_either_pose() {
    let mut surface = SkinnedSurface::new(tube(4, 8));
    let mut patch = Patch::default();
    let (low, high) = (Vec3::splat(-9.0), Vec3::splat(9.0));
    let poses = [0.0, 0.3].map(|angle| bend(4, DVec3::Z, angle));
    let root = Similarity::IDENTITY;
    let mut update = |surface: &SkinnedSurface| patch.update(surface, low, high, 1.0);
    assert_eq!(update(&surface), PatchChange::Rebuilt);
    assert_eq!(update(&surface), PatchChange::Same);
    surface.teleport(&poses[0], root).unwrap();
    update(&surface);
    surface.advance(&poses[0], root).unwrap();
    assert_eq!(update(&surface), PatchChange::Same);
    surface.advance(&poses[1], root).unwrap();
    assert_eq!(update(&surface), PatchChange::Moved);
    // The surface came to rest: only the previous pose is new.
    surface.advance(&poses[1], root).unwrap();
    assert_eq!(update(&surface), PatchChange::Moved);
    surface.advance(&poses[1], root).unwrap();
    assert_eq!(update(&surface), PatchChange::Same);
    // The surface stands still in another pose.
    surface.teleport(&poses[0], root).unwrap();
    assert_eq!(update(&surface), PatchChange::Moved);
}

#[test]
fn another_surface_rebuilds_the_patch() {
    let (low, high) = (Vec3::splat(-9.0), Vec3::splat(9.0));
    let mut patch = Patch::default();
    for (joints, sides) in [(4, 8), (6, 12), (3, 5)] {
        let surface = SkinnedSurface::new(tube(joints, sides));
        let change = patch.update(&surface, low, high, 1.0);
        assert_eq!(change, PatchChange::Rebuilt, "{joints} {sides}");
        assert_eq!(patch.triangles(), near(&surface, low, high));
    }
}

#[test]
fn a_patch_away_from_the_skin_is_empty() {
    let surface = SkinnedSurface::new(tube(4, 8));
    let mut patch = Patch::default();
    let low = Vec3::splat(20.0);
    for _ in 0..2 {
        let change = patch.update(&surface, low, low, 30.0);
        assert_eq!(change, PatchChange::Same);
        assert!(patch.is_empty());
    }
}

#[test]
fn bad_boxes_and_margins_hold_nothing() {
    let surface = SkinnedSurface::new(tube(4, 8));
    let mut patch = Patch::default();
    let mut check = |low: Vec3, high: Vec3, margin: f32| {
        patch.update(&surface, Vec3::ZERO, Vec3::ONE, 0.0);
        assert!(!patch.is_empty());
        let change = patch.update(&surface, low, high, margin);
        assert_eq!(change, PatchChange::Rebuilt, "{low} {high} {margin}");
        assert!(patch.is_empty(), "{low} {high} {margin}");
        let change = patch.update(&surface, low, high, margin);
        assert_eq!(change, PatchChange::Same, "{low} {high} {margin}");
    };
    let nan = Vec3::new(0.0, f32::NAN, 0.0);
    for (low, high, margin) in [
        (nan, Vec3::ONE, 0.0),
        (Vec3::ZERO, nan, 0.0),
        (Vec3::ZERO, Vec3::INFINITY, 0.0),
        (Vec3::MIN, Vec3::MAX, f32::MAX),
    ] {
        check(low, high, margin);
    }
    for margin in [-1.0, f32::NAN, f32::INFINITY] {
        check(Vec3::ZERO, Vec3::ONE, margin);
    }
    // `low` above `high`: nothing.
    check(Vec3::ONE, Vec3::ZERO, 0.0);
}
