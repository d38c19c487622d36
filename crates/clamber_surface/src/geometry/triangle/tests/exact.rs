//! Points and segments against exact rational arithmetic.

use clamber_verify::exact::{
    Exact, Relaxed, between_triangle_and_segment, exact, from_triangle, length_sq, minus, number,
    plus,
};

use super::cases::{moved, query, segment, triangle};
use super::*;

/// Largest allowed error of a distance, as a share of the lengths involved. In 600,000 cases all errors but 20 stay
/// below 5e-15, and slivers reach 1e-12; a result that is wrong by more than rounding shows 1e-10.
const TOLERANCE: f64 = 5e-12;

/// The point with the weights found; asserts that they are the weights of a point of the triangle.
fn point_of(corners: &[Exact; 3], found: &TrianglePoint) -> Exact {
    let weights = found.barycentric.to_array();
    assert!(weights.iter().all(|w| *w >= 0.0), "{found:?}");
    let sum: f64 = weights.iter().sum();
    assert!((sum - 1.0).abs() <= 4e-16, "{found:?} {corners:?}");
    let weights = weights.map(number);
    let sum = &weights[0] + &weights[1] + &weights[2];
    let origin = [Relaxed::ZERO, Relaxed::ZERO, Relaxed::ZERO];
    let mut at = origin;
    for (corner, weight) in corners.iter().zip(&weights) {
        let share = weight / &sum;
        at = plus(&at, &corner.each_ref().map(|x| x * &share));
    }
    at
}

/// `sqrt(x) - sqrt(y)` without cancellation.
fn roots_apart(x: &Relaxed, y: &Relaxed) -> f64 {
    let sum = x.to_f64_fast().sqrt() + y.to_f64_fast().sqrt();
    if sum == 0.0 {
        0.0
    } else {
        (x - y).to_f64_fast() / sum
    }
}

fn longest_edge([a, b, c]: [Vec3; 3]) -> f64 {
    let length = |a: Vec3, b: Vec3| (widen(b) - widen(a)).length();
    length(a, b).max(length(b, c)).max(length(c, a))
}

/// Errors of the distance and of the point, as shares of the lengths involved.
fn errors(found: &TrianglePoint, truth: &Relaxed, at: &Relaxed, size: f64) -> [f64; 2] {
    let reported = number(found.distance);
    let size = size + truth.to_f64_fast().sqrt();
    let shares = [
        roots_apart(&(&reported * &reported), truth).abs(),
        roots_apart(at, truth),
    ];
    shares.map(|error| if error == 0.0 { 0.0 } else { error / size })
}

/// Asserts that errors are allowed, and remembers the worst.
fn note(worst: &mut [f64; 2], errors: [f64; 2], case: impl std::fmt::Display) {
    for (worst, error) in worst.iter_mut().zip(errors) {
        assert!(error <= TOLERANCE, "{case}: off by {error:e}");
        *worst = worst.max(error);
    }
}

fn offset(case: u32) -> Vec3 {
    [Vec3::ZERO, Vec3::new(1000.0, -1000.0, 1000.0)][case as usize % 2]
}

fn points(cases: u32) -> [f64; 2] {
    let mut rng = fastrand::Rng::with_seed(50);
    let mut worst = [0.0f64; 2];
    for case in 0..cases {
        let corners = triangle(&mut rng);
        let [a, b, c, p] = {
            let [a, b, c] = corners;
            moved([a, b, c, query(&mut rng, corners)], offset(case))
        };
        let corners = [a, b, c];
        let found = closest_point(corners, p);
        let (wide, q) = (corners.map(exact), exact(p));
        let truth = length_sq(&from_triangle(&q, &wide));
        let at = length_sq(&minus(&point_of(&wide, &found), &q));
        let errors = errors(&found, &truth, &at, longest_edge(corners));
        let case = format_args!("case {case}: {corners:?} {p}: {found:?}");
        note(&mut worst, errors, case);
    }
    worst
}

fn segments(cases: u32) -> [f64; 2] {
    let mut rng = fastrand::Rng::with_seed(51);
    let mut worst = [0.0f64; 2];
    for case in 0..cases {
        let corners = triangle(&mut rng);
        let [a, b, c, p, q] = {
            let [p, q] = segment(&mut rng, corners);
            let [a, b, c] = corners;
            moved([a, b, c, p, q], offset(case))
        };
        let corners = [a, b, c];
        let found = closest_to_segment(corners, p, q);
        let (wide, [from, to]) = (corners.map(exact), [p, q].map(exact));
        let truth = length_sq(&between_triangle_and_segment(&wide, [&from, &to]));
        // A segment is a collapsed triangle: both have the same distance.
        let point = point_of(&wide, &found);
        let at = length_sq(&from_triangle(&point, &[from.clone(), to.clone(), to]));
        let size = longest_edge(corners) + (widen(q) - widen(p)).length();
        let errors = errors(&found, &truth, &at, size);
        let case = format_args!("case {case}: {corners:?} {p} {q}: {found:?}");
        note(&mut worst, errors, case);
    }
    worst
}

#[test]
fn closest_point_agrees_with_exact_arithmetic() {
    let worst = points(3_000);
    println!("worst errors of distance and point: {worst:?}");
}

#[test]
fn closest_to_segment_agrees_with_exact_arithmetic() {
    let worst = segments(3_000);
    println!("worst errors of distance and point: {worst:?}");
}

#[test]
fn ray_meets_a_triangle_exactly_where_the_edge_functions_say_so() {
    let mut rng = fastrand::Rng::with_seed(52);
    let (mut hits, mut misses) = (0, 0);
    for case in 0..20_000 {
        let [a, c] = [(); 2].map(|()| point(&mut rng, 1.0));
        // The edge passes the ray within rounding.
        let mut b = a * -rng.f32();
        b.z = rng.f32();
        let corners = [a, b, c].map(|p| [p.x, p.y, p.z + 2.0]);
        let wide = corners.map(|corner| corner.map(|x| number(f64::from(x))));
        let edge = |i: usize, j: usize| &wide[i][0] * &wide[j][1] - &wide[i][1] * &wide[j][0];
        let (u, v, w) = (edge(2, 1), edge(0, 2), edge(1, 0));
        let zero = Relaxed::ZERO;
        let meets = (u >= zero && v >= zero && w >= zero) || (u <= zero && v <= zero && w <= zero);
        let found = intersect_sheared(corners, f64::INFINITY);
        assert_eq!(found.is_some(), meets, "case {case} {corners:?}");
        let sum = &u + &v + &w;
        if let Some(found) = found {
            let truth = [u, v, w].map(|part| (part / &sum).to_f64_fast());
            let off = (found.barycentric - DVec3::from_array(truth)).length();
            assert!(
                off < 1e-15,
                "case {case} {corners:?}: {found:?} for {truth:?}"
            );
            hits += 1;
        } else {
            misses += 1;
        }
    }
    assert!(hits > 1_000 && misses > 1_000, "{hits} {misses}");
}

#[test]
#[ignore = "minutes in a debug build: run it in release"]
fn many_more_points_and_segments_agree_with_exact_arithmetic() {
    println!(
        "points {:?}, segments {:?}",
        points(300_000),
        segments(300_000)
    );
}
