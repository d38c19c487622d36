//! `is_inside` compared with the winding number from the solid angle.

use glam::{DVec3, Vec3};

use crate::geometry::Ray;
use crate::measure::winding_number;
use crate::mesh::TriangleId;
use crate::query::inside::DIRECTIONS;
use crate::surface::SkinnedSurface;
use crate::testing::{advance, bend, point, positions_of, tube};

/// Compares at a point; returns the winding number.
fn assert_agrees(surface: &SkinnedSurface, positions: &[Vec3], place: Vec3, case: &str) -> f64 {
    let winding = winding_number(positions, surface.mesh(), place.as_dvec3());
    let inside = surface.in_model().is_inside(place);
    let wanted = winding > 0.5;
    assert_eq!(inside, wanted, "{case}: winds {winding} around {place}");
    winding
}

#[test]
fn a_bent_tube_that_overlaps_itself_agrees_with_the_solid_angle() {
    let mut rng = fastrand::Rng::with_seed(76);
    let mut surface = SkinnedSurface::new(tube(10, 12));
    let (mut inside, mut overlapping) = (0, 0);
    // At the last angle the tube overlaps itself.
    for angle in [0.0, 0.2, 0.5, 0.9] {
        let bent = bend(10, DVec3::new(0.0, 0.8, 0.6), angle);
        advance(&mut surface, &bent);
        let positions = positions_of(&surface);
        for _ in 0..4_000 {
            let near = positions[rng.usize(0..positions.len())];
            let place = near + point(&mut rng, 0.6);
            let winding = assert_agrees(&surface, &positions, place, &format!("{angle} rad"));
            inside += u32::from(winding > 0.5);
            overlapping += u32::from(winding > 1.5);
        }
    }
    assert!(inside > 2_000 && overlapping > 20, "{inside} {overlapping}");
}

#[test]
fn a_ray_through_edges_and_corners_is_outvoted() {
    let mut rng = fastrand::Rng::with_seed(77);
    let mut surface = SkinnedSurface::new(tube(6, 8));
    advance(&mut surface, &bend(6, DVec3::Z, 0.3));
    let positions = positions_of(&surface);
    for direction in DIRECTIONS {
        for _ in 0..2_000 {
            let triangles = surface.mesh().triangles();
            let corners = triangles[rng.usize(0..triangles.len())];
            let [a, b, _] = corners.map(|v| positions[v.index()]);
            let target = a + (b - a) * [0.0, 0.5, rng.f32()][rng.usize(0..3)];
            let distance = (rng.f32() + 0.01) * [-1.0, 1.0, 3.0][rng.usize(0..3)];
            let place = target - direction * distance;
            assert_agrees(&surface, &positions, place, "towards an edge");
        }
    }
}

#[test]
fn a_hole_in_one_direction_is_outvoted() {
    // For a point in the middle of each ring, hides the triangle through which one of the rays leaves.
    let whole = SkinnedSurface::new(tube(6, 16));
    for x in [0.6, 2.1, 4.4] {
        let middle = Vec3::new(x, 0.05, -0.03);
        assert!(whole.in_model().is_inside(middle));
        for direction in DIRECTIONS {
            let mut surface = whole.clone();
            let ray = Ray::new(middle, direction).unwrap();
            let hit = surface.in_model().cast_ray(&ray, 10.0).unwrap();
            surface.disable_triangle(hit.triangle).unwrap();
            assert!(
                surface.in_model().is_inside(middle),
                "{direction} from {middle}"
            );
            assert!(!surface.in_model().is_inside(middle + Vec3::Y));
        }
    }
}

#[test]
fn an_open_sheet_has_no_inside_beyond_half_its_size() {
    // The end cap of a tube, seen from the front and from behind.
    let mut surface = SkinnedSurface::new(tube(3, 16));
    let mesh = surface.mesh().clone();
    let tip = mesh.positions().len() - 1;
    for (triangle, corners) in (0..).map(TriangleId).zip(mesh.triangles()) {
        if corners.iter().all(|v| v.index() != tip) {
            surface.disable_triangle(triangle).unwrap();
        }
    }
    for x in [1.0, 1.5, 2.5, 3.0] {
        let place = Vec3::new(x, 0.1, 0.05);
        assert!(!surface.in_model().is_inside(place), "{place}");
    }
}

#[test]
fn points_that_are_not_finite_are_outside() {
    let surface = SkinnedSurface::new(tube(2, 3));
    for bad in [Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        assert!(!surface.in_model().is_inside(bad), "{bad}");
    }
}
