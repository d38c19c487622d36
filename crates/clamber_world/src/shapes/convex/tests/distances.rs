use clamber_surface::geometry::rotation_from_axis_angle;

use super::*;
use crate::RigidPose;

#[test]
fn nearest_points_agree_with_a_search_and_a_plane_separates_the_two() {
    let mut rng = fastrand::Rng::with_seed(51);
    let mut apart = 0;
    for round in 0..400 {
        for case in cases(&mut rng) {
            let ends = segment(&mut rng, 2.0);
            let expected = case.distance(ends);
            let convex = case.convex();
            let found = MovingConvex::still(&convex).nearest(0.0, ends, point(&mut rng, 1.0));
            let name = case.name;
            let Some(found) = found else {
                assert!(expected < 1e-7, "{name} {round} {ends:?}: {expected}");
                continue;
            };
            apart += 1;
            let distance = found.distance;
            let told = format!("{name} {round} {ends:?}: {found:?}");
            assert!((distance - expected).abs() < 2e-7, "{told} for {expected}");
            // A plane separates the two.
            let gap = ends.map(|end| end.dot(found.normal) - convex.extent(found.normal));
            let gap = gap[0].min(gap[1]);
            assert!(gap > distance - 1e-7, "{told}: {gap}");
            assert!((found.normal.length() - 1.0).abs() < 1e-12, "{told}");
        }
    }
    assert!(apart > 2_000, "{apart}");
}

#[test]
fn nearest_points_are_right_from_a_micrometre_to_a_kilometre() {
    let mut rng = fastrand::Rng::with_seed(52);
    for round in 0..200 {
        for case in cases(&mut rng) {
            for away in [1e-6, 1e-3, 1e3] {
                let n = direction(&mut rng);
                let convex = case.convex();
                let at = convex.support(n) + n * away;
                let along = n.any_orthonormal_vector() * rng.f64();
                let ends = [at - along, at + along];
                let expected = case.distance(ends);
                let found = MovingConvex::still(&convex).nearest(0.0, ends, DVec3::ZERO);
                let distance = found.map_or(0.0, |found| found.distance);
                let told = format!("{} {round} {ends:?}: {distance}", case.name);
                let off = (distance - expected).abs();
                assert!(off < 1e-7 + expected * 1e-7, "{told} for {expected}");
                let off = (distance - away).abs();
                assert!(off < 1e-7 + away * 1e-6, "{told} for {away}");
            }
        }
    }
}

/// The fast path for a cuboid's faces agrees with the search among corners, in all poses that a solid has during a
/// tick.
#[test]
fn above_a_face_of_a_cuboid_nearest_points_are_those_of_a_hull_of_its_corners() {
    let mut rng = fastrand::Rng::with_seed(23);
    let (mut on_face, mut elsewhere, mut met) = (0, 0, 0);
    for round in 0..20_000 {
        let half = Vec3::new(0.2 + rng.f32(), 0.1 + rng.f32(), 0.3 + rng.f32());
        let corners: Vec<Vec3> = (0..8)
            .map(|k| {
                let sign = |bit: u32| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
                half * Vec3::new(sign(0), sign(1), sign(2))
            })
            .collect();
        let hull = ConvexPolyhedron::from_convex_hull(&corners).unwrap();
        let cuboid = Cuboid::new(half);
        let [cuboid, hull] =
            [&cuboid as &dyn parry3d::shape::Shape, &hull].map(|shape| Convex::new(shape).unwrap());
        let turn = if round % 3 == 0 { 0.0 } else { rng.f64() * 0.5 };
        let before = (round % 4 > 0).then(|| RigidPose {
            rotation: rotation_from_axis_angle(direction(&mut rng), turn),
            translation: point(&mut rng, 0.5),
        });
        let ends = match round % 5 {
            // A ball, and an upright capsule.
            0 => [point(&mut rng, 2.0); 2],
            1 => {
                let low = point(&mut rng, 2.0);
                [low, low + DVec3::Y]
            }
            // Level, as near at one end as at the other.
            2 => {
                let one = point(&mut rng, 2.0);
                [one, DVec3::new(rng.f64(), one.y, rng.f64())]
            }
            _ => segment(&mut rng, 2.0),
        };
        for time in [0.0, 0.4, 1.0] {
            let nearest = [&cuboid, &hull].map(|convex| {
                let moving = MovingConvex { convex, before };
                moving.nearest(time, ends, DVec3::ZERO)
            });
            let [Some(own), Some(other)] = nearest else {
                assert!(nearest.iter().all(Option::is_none), "{nearest:?}");
                met += 1;
                continue;
            };
            let off = (own.distance - other.distance).abs();
            assert!(off < 1e-9, "{round}: {nearest:?}");
            let off = (own.normal - other.normal).length();
            assert!(off < 1e-4, "{round}: {nearest:?}");
            let inside = own.on_core.abs().cmple(half.as_dvec3() + 1e-12);
            assert!(inside.all(), "{round}: {own:?}");
            let is_axis = own.normal.abs().max_element() == 1.0;
            on_face += usize::from(is_axis);
            elsewhere += usize::from(!is_axis);
        }
    }
    assert!(
        on_face > 5_000 && elsewhere > 5_000 && met > 1_000,
        "{on_face} {elsewhere} {met}"
    );
}
