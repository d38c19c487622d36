mod bits;
mod cases;
mod exact;
mod leaks;
mod moving;

use super::*;
use crate::geometry::{Ray, round_to_f32};
use crate::testing::point;

/// Nearest distance by another method: a search over the barycentric coordinates, a coarse grid refined around its best
/// cell until the cell is below rounding.
fn distance_by_search(corners: [Vec3; 3], p: Vec3) -> f64 {
    let p = widen(p);
    let [a, b, c] = corners.map(|corner| widen(corner) - p);
    let at = |u: f64, v: f64| (a * (1.0 - u - v) + b * u + c * v).length();
    let (mut best, mut centre, mut half) = (f64::INFINITY, (1.0 / 3.0, 1.0 / 3.0), 1.0);
    for _ in 0..60 {
        let middle = centre;
        for i in -6..=6 {
            for j in -6..=6 {
                let u = (middle.0 + half * f64::from(i) / 6.0).clamp(0.0, 1.0);
                let v = (middle.1 + half * f64::from(j) / 6.0).clamp(0.0, 1.0 - u);
                let d = at(u, v);
                if d < best {
                    best = d;
                    centre = (u, v);
                }
            }
        }
        half *= 0.6;
    }
    best
}

#[test]
fn closest_point_agrees_with_search() {
    let mut rng = fastrand::Rng::with_seed(1);
    for case in 0..300 {
        let corners = [(); 3].map(|()| point(&mut rng, 1.0));
        let p = point(&mut rng, 1.0) * 2.0;
        let found = closest_point(corners, p);
        let searched = distance_by_search(corners, p);
        let off = (found.distance - searched).abs();
        assert!(
            off < 1e-6,
            "case {case} {corners:?} {p}: {found:?} against {searched}"
        );
        let back = (point_at(corners, found.barycentric) - widen(p)).length();
        assert!((back - found.distance).abs() < 1e-12, "case {case}");
    }
}

#[test]
fn closest_point_meets_the_optimality_condition_on_slivers_far_out() {
    // Convexity: q is nearest if and only if no corner lies nearer along q - p than q itself.
    let mut rng = fastrand::Rng::with_seed(2);
    for case in 0..20_000 {
        let thin = [1.0, 1e-3, 1e-6, 0.0][case % 4];
        let offset = [0.0, 1000.0][(case / 4) % 2];
        let a = point(&mut rng, 1.0) + Vec3::splat(offset);
        let b = point(&mut rng, 1.0) + Vec3::splat(offset);
        let c = a + (b - a) * rng.f32() + point(&mut rng, 1.0) * thin;
        let p = point(&mut rng, 1.0) * 2.0 + Vec3::splat(offset);
        let found = closest_point([a, b, c], p);
        let q = point_at([a, b, c], found.barycentric) - widen(p);
        for corner in [a, b, c] {
            let slack = q.dot(widen(corner) - widen(p) - q);
            let allowed = -1e-7 * (1.0 + q.length());
            assert!(slack >= allowed, "case {case} {a} {b} {c} {p}: {slack}");
        }
    }
}

#[test]
fn closest_point_of_a_sliver_with_a_poor_normal_in_f32() {
    // Catto's triangle, whose normal keeps two digits in f32.
    let corners = [
        Vec3::new(0.331_916_57, 0.382_771_94, -0.465_963_87),
        Vec3::new(0.378_853_9, -0.246_981_59, -0.440_359_06),
        Vec3::new(0.331_879_08, 0.382_861_08, -0.465_974),
    ];
    let p = Vec3::new(0.5, 0.1, -0.2);
    let found = closest_point(corners, p);
    assert!((found.distance - distance_by_search(corners, p)).abs() < 1e-9);
}

#[test]
fn two_triangles_find_the_same_distance_to_the_edge_they_share() {
    let mut rng = fastrand::Rng::with_seed(4);
    let mut shared = 0;
    for case in 0..5_000 {
        let [a, b] = [(); 2].map(|()| point(&mut rng, 1.0));
        // The third corners of both triangles point away from p, so that the shared edge is nearest for both.
        let p = (a + b) * 0.5 + point(&mut rng, 1.0) * 0.3;
        let away = (a + b) * 0.5 - p;
        let [c, d] = [(); 2].map(|()| a + away * 3.0 + point(&mut rng, 1.0) * 0.1);
        let (one, other) = (closest_point([a, b, c], p), closest_point([d, b, a], p));
        if one.barycentric.z == 0.0 && other.barycentric.x == 0.0 {
            let [one, other] = [one, other].map(|found| found.distance.to_bits());
            assert_eq!(one, other, "case {case}");
            shared += 1;
        }
    }
    assert!(shared > 1_000, "{shared}");
}

#[test]
fn collapsed_triangle_answers_as_segment_and_as_point() {
    let a = Vec3::new(1.0, 0.0, 0.0);
    let b = Vec3::new(3.0, 0.0, 0.0);
    let found = closest_point([a, b, a], Vec3::new(2.0, 2.0, 0.0));
    assert!((found.distance - 2.0).abs() < 1e-12);
    let first_edge = DVec3::new(0.5, 0.5, 0.0);
    assert_eq!(found.barycentric, first_edge, "the first of equal edges");
    let found = closest_point([a, a, a], Vec3::new(1.0, 5.0, 0.0));
    assert!((found.distance - 5.0).abs() < 1e-12);
}

#[test]
fn segment_through_a_face_is_at_distance_zero_from_its_crossing_point() {
    let mut rng = fastrand::Rng::with_seed(5);
    for case in 0..20_000 {
        let corners = [(); 3].map(|()| point(&mut rng, 1.0));
        let (u, v) = (rng.f32() * 0.4 + 0.1, rng.f32() * 0.4 + 0.1);
        let [a, b, c] = corners;
        let inside = a + (b - a) * u + (c - a) * v;
        let along = point(&mut rng, 1.0);
        let normal = round_to_f32(scaled_normal(corners).normalize());
        if scaled_normal(corners).length() < 0.1 || normal.dot(along).abs() < 0.1 {
            continue;
        }
        let p = inside - along * 0.5;
        let found = closest_to_segment(corners, p, inside + along);
        assert_eq!(found.distance, 0.0, "case {case} {corners:?} {p} {along}");
        let at = round_to_f32(point_at(corners, found.barycentric));
        let off = (at - inside).length();
        assert!(off < 1e-5, "case {case}: {at} for {inside}");
    }
}

#[test]
fn segments_beside_above_and_parallel_to_a_triangle() {
    let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0];
    let distance = |a: [f32; 3], b: [f32; 3]| {
        let found = closest_to_segment(corners, Vec3::from(a), Vec3::from(b));
        let at = point_at(corners, found.barycentric);
        (found.distance, round_to_f32(at))
    };
    let found = distance([0.5, 0.5, 1.0], [0.5, 0.5, 3.0]);
    let wanted = (1.0, Vec3::new(0.5, 0.5, 0.0));
    assert_eq!(found, wanted, "one end above the face");
    let found = distance([0.25, 0.25, 2.0], [0.75, 0.75, 2.0]);
    assert_eq!(found.0, 2.0, "parallel to the face");
    let found = distance([0.5, -3.0, -1.0], [0.5, -3.0, 4.0]);
    assert_eq!(found, (3.0, Vec3::X * 0.5), "beside an edge");
    let found = distance([-4.0, -3.0, -1.0], [-4.0, -3.0, 1.0]);
    assert_eq!(found, (5.0, Vec3::ZERO), "beside a corner");
    let found = distance([-1.0, -1.0, 0.0], [3.0, -1.0, 0.0]);
    assert_eq!(found.0, 1.0, "parallel to an edge, in the plane");
    let found = distance([0.25, 0.25, 0.0], [0.5, 0.5, 0.0]);
    assert_eq!(found.0, 0.0, "inside the face");
    let found = distance([-1.0, 0.5, 0.0], [1.0, 0.5, 0.0]);
    assert_eq!(found.0, 0.0, "across an edge in the plane");
}

#[test]
fn ray_meets_both_sides_and_borders_but_not_edge_on() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let meets = |origin, direction| {
        let ray = Ray::new(origin, direction).unwrap();
        ShearedRay::new(&ray).intersect(corners, f64::INFINITY)
    };
    for side in [1.0, -1.0] {
        let from = |x, y| meets(Vec3::new(x, y, 2.0 * side), Vec3::new(0.0, 0.0, -side));
        let hit = from(0.25, 0.25).unwrap();
        assert_eq!(hit.distance, 2.0);
        assert_eq!(hit.barycentric, DVec3::new(0.5, 0.25, 0.25));
        assert!(from(0.0, 0.0).is_some(), "corner");
        assert!(from(0.5, 0.5).is_some(), "edge");
        assert!(from(0.6, 0.6).is_none(), "outside");
        assert!(meets(Vec3::new(0.1, 0.1, side), Vec3::new(0.0, 0.0, side)).is_none());
    }
    let edge_on = meets(Vec3::new(-1.0, 0.2, 0.0), Vec3::X);
    assert!(edge_on.is_none(), "edge-on");
}

#[test]
fn rays_at_edges_and_corners_of_a_closed_mesh_do_not_leak() {
    // An octahedron split three times: 512 triangles around the origin, near and far out.
    for offset in [Vec3::ZERO, Vec3::splat(1000.0)] {
        let mut positions = vec![Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        let mut triangles = vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ];
        for _ in 0..3 {
            let mut middles = std::collections::BTreeMap::new();
            let mut middle = |a: usize, b: usize, positions: &mut Vec<Vec3>| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push((positions[a] + positions[b]).normalize());
                    positions.len() - 1
                })
            };
            triangles = triangles
                .iter()
                .flat_map(|&[a, b, c]| {
                    let ab = middle(a, b, &mut positions);
                    let bc = middle(b, c, &mut positions);
                    let ca = middle(c, a, &mut positions);
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        let positions: Vec<Vec3> = positions.iter().map(|p| *p + offset).collect();
        let mut rng = fastrand::Rng::with_seed(3);
        for _ in 0..5_000 {
            let triangle = triangles[rng.usize(0..triangles.len())];
            let along = [0.0, rng.f32()][rng.usize(0..2)];
            let target = positions[triangle[0]].lerp(positions[triangle[1]], along);
            let origin = offset + point(&mut rng, 1.0) * 0.3;
            let ray = Ray::new(origin, target - origin).unwrap();
            let sheared = ShearedRay::new(&ray);
            let met = triangles.iter().any(|t| {
                let corners = t.map(|v| positions[v]);
                sheared.intersect(corners, f64::INFINITY).is_some()
            });
            assert!(met, "leak: {ray:?} at {target}");
        }
    }
}
