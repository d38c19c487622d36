use super::*;

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
            assert!(
                (distance - expected).abs() < 2e-7,
                "{name} {round} {ends:?}: {found:?} for {expected}"
            );
            // A plane separates the two.
            let gap = ends.map(|end| end.dot(found.normal) - convex.extent(found.normal));
            let gap = gap[0].min(gap[1]);
            assert!(
                gap > distance - 1e-7,
                "{name} {round} {ends:?}: {gap} {found:?}"
            );
            assert!(
                (found.normal.length() - 1.0).abs() < 1e-12,
                "{name} {found:?}"
            );
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
                assert!(
                    (distance - expected).abs() < 1e-7 + expected * 1e-7,
                    "{} {round} {ends:?}: {distance} for {expected}",
                    case.name
                );
                assert!(
                    (distance - away).abs() < 1e-7 + away * 1e-6,
                    "{}",
                    case.name
                );
            }
        }
    }
}
