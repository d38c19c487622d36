//! Tests of eight triangles at a time give the bits of the scalar tests, at every SIMD level.

use super::cases::{moved, query, segment, triangle};
use super::*;
use crate::simd::SimdLevel;

fn bits(found: &TrianglePoint) -> [u64; 4] {
    let [a, b, c] = found.barycentric.to_array();
    [a, b, c, found.distance].map(f64::to_bits)
}

/// A random map of points: scales from subnormal to huge, with and without an offset.
fn place(rng: &mut fastrand::Rng) -> impl Fn(Vec3) -> Vec3 + use<> {
    let scale = [1.0, 1.0, 1e-40, 1e-20, 1e20, (1u128 << 90) as f32][rng.usize(0..6)];
    let offset = [0.0, 0.0, 1000.0, -0.1][rng.usize(0..4)];
    move |p| (p + Vec3::splat(offset)) * scale
}

fn compare(batches: u32, seed: u64) {
    let levels = SimdLevel::available();
    let mut rng = fastrand::Rng::with_seed(seed);
    for batch in 0..batches {
        let place = place(&mut rng);
        let triangles = [(); EIGHT].map(|()| triangle(&mut rng).map(&place));
        let unplaced = triangle(&mut rng);
        let p = place(query(&mut rng, unplaced));
        let [a, b] = segment(&mut rng, unplaced).map(&place);
        let mut corners = Corners8::default();
        for (lane, triangle) in triangles.iter().enumerate() {
            corners.set(lane, *triangle);
        }
        for level in &levels {
            let mut points = Points8::default();
            closest_points(*level, &corners, p, &mut points);
            let mut segments = Points8::default();
            closest_to_segments(*level, &corners, [a, b], &mut segments);
            for (lane, triangle) in triangles.iter().enumerate() {
                let one = closest_point(*triangle, p);
                let case = format_args!("{level} batch {batch} {triangle:?}");
                assert_eq!(bits(&points.get(lane)), bits(&one), "{case} {p}");
                assert!(one.distance.is_finite(), "{case} {p}");
                assert!(one.barycentric.is_finite(), "{case} {p}");
                let one = closest_to_segment(*triangle, a, b);
                assert!(one.distance.is_finite(), "{case} {a} {b}");
                assert!(one.barycentric.is_finite(), "{case} {a} {b}");
                assert_eq!(bits(&segments.get(lane)), bits(&one), "{case} {a} {b}");
            }
        }
    }
}

#[test]
fn eight_lanes_have_the_scalar_bits_at_every_level() {
    compare(4_000, 40);
}

#[test]
#[ignore = "a million triangles: run it in release"]
fn eight_lanes_have_the_scalar_bits_for_a_million_triangles() {
    compare(130_000, 41);
}

#[test]
fn swapped_ends_and_segments_of_zero_length_give_the_same_bits() {
    let mut rng = fastrand::Rng::with_seed(42);
    for case in 0..20_000 {
        let corners = triangle(&mut rng);
        let place = place(&mut rng);
        let [a, b] = segment(&mut rng, corners).map(&place);
        let corners = corners.map(&place);
        let found = bits(&closest_to_segment(corners, a, b));
        let swapped = bits(&closest_to_segment(corners, b, a));
        assert_eq!(found, swapped, "case {case} {corners:?} {a} {b}");
        let (segment, point) = (closest_to_segment(corners, a, a), closest_point(corners, a));
        assert_eq!(bits(&segment), bits(&point), "case {case} {corners:?} {a}");
    }
}

#[test]
fn segment_distances_to_a_shared_edge_have_the_same_bits() {
    let mut rng = fastrand::Rng::with_seed(43);
    let mut shared = 0;
    for case in 0..5_000 {
        let offset = Vec3::splat([0.0, 1000.0][case % 2]);
        let [a, b] = [(); 2].map(|()| point(&mut rng, 1.0));
        let p = (a + b) * 0.5 + point(&mut rng, 1.0) * 0.3;
        let away = (a + b) * 0.5 - p;
        let q = p + point(&mut rng, 1.0) * 0.2;
        let [c, d] = [(); 2].map(|()| a + away * 3.0 + point(&mut rng, 1.0) * 0.1);
        let [a, b, c, d, p, q] = moved([a, b, c, d, p, q], offset);
        let one = closest_to_segment([a, b, c], p, q);
        let other = closest_to_segment([d, b, a], p, q);
        if one.barycentric.z == 0.0 && other.barycentric.x == 0.0 {
            let (one, other) = (one.distance.to_bits(), other.distance.to_bits());
            assert_eq!(one, other, "case {case} {a} {b} {p} {q}");
            shared += 1;
        }
    }
    assert!(shared > 1_000, "{shared}");
}
