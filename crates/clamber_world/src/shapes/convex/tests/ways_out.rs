use super::*;

/// The least depth over many random directions, with a local search from the best four.
fn depth_by_search(convex: &Convex<'_>, ends: [DVec3; 2], rng: &mut fastrand::Rng) -> f64 {
    let depth = |n: DVec3| {
        let behind = ends.map(|end| n.dot(end));
        convex.extent(n) - behind[0].min(behind[1])
    };
    let mut tried: Vec<(f64, DVec3)> = (0..4_000)
        .map(|_| direction(rng))
        .map(|n| (depth(n), n))
        .collect();
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut least = f64::INFINITY;
    for (mut best, mut at) in tried.into_iter().take(4) {
        let mut step = 0.1;
        while step > 1e-9 {
            let next = (at + point(rng, step)).normalize();
            if depth(next) < best {
                (best, at) = (depth(next), next);
                step *= 1.5;
            } else {
                step *= 0.97;
            }
        }
        least = least.min(best);
    }
    least
}

#[test]
fn minimum_translations_lead_out_and_none_is_shorter() {
    let mut rng = fastrand::Rng::with_seed(53);
    let mut inside = 0;
    for round in 0..120 {
        for case in cases(&mut rng) {
            let ends = segment(&mut rng, 0.4);
            let convex = case.convex();
            if MovingConvex::still(&convex)
                .nearest(0.0, ends, DVec3::ZERO)
                .is_some()
            {
                continue;
            }
            inside += 1;
            let name = case.name;
            let out = convex.way_out(ends);
            assert!((out.normal.length() - 1.0).abs() < 1e-12, "{name} {out:?}");
            let depth = -out.distance - convex.round;
            assert!(depth >= 0.0, "{name} {out:?}");
            let expected = depth_by_search(&convex, ends, &mut rng);
            // Edges between faces that parry merges are not tried.
            let slack = if name == "hull" {
                0.02 * expected
            } else {
                1e-5
            };
            assert!(
                depth <= expected + slack,
                "{name} {round} {ends:?}: {out:?}, but {expected} is enough"
            );
            let moved = ends.map(|end| end + out.normal * (depth + 1e-6));
            let apart = MovingConvex::still(&convex).nearest(0.0, moved, out.normal);
            assert!(apart.is_some(), "{name} {round} {ends:?}: {out:?}");
            let off = case.distance([out.point - out.normal * convex.round; 2]);
            assert!(off < 1e-6, "{name} {round} {ends:?}: {out:?} is {off} off");
        }
    }
    assert!(inside > 300, "{inside}");
}

#[test]
fn a_segment_through_the_middle_has_a_minimum_translation() {
    let mut rng = fastrand::Rng::with_seed(54);
    let lines = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z * 1e-9];
    for case in cases(&mut rng) {
        for along in lines {
            let convex = case.convex();
            let out = convex.way_out([-along, along]);
            let usable = out.point.is_finite() && out.distance.is_finite();
            assert!(usable && out.distance <= 0.0, "{} {out:?}", case.name);
            assert!(
                (out.normal.length() - 1.0).abs() < 1e-12,
                "{} {out:?}",
                case.name
            );
        }
    }
}
