//! Temporary: old code, and time.
use super::cases::*;
use super::*;
use crate::simd::SimdLevel;
use std::hint::black_box;
use std::time::Instant;

fn old_closest_point(corners: [Vec3; 3], p: Vec3) -> TrianglePoint {
    let p = widen(p);
    let [a, b, c] = corners.map(|corner| widen(corner) - p);
    let mut best = closest_on_edge(a, b, |t| DVec3::new(1.0 - t, t, 0.0));
    for edge in [
        closest_on_edge(b, c, |t| DVec3::new(0.0, 1.0 - t, t)),
        closest_on_edge(c, a, |t| DVec3::new(t, 0.0, 1.0 - t)),
    ] {
        if edge.distance < best.distance {
            best = edge;
        }
    }
    let normal = (b - a).cross(c - a);
    let weights = DVec3::new(
        normal.dot(b.cross(c)),
        normal.dot(c.cross(a)),
        normal.dot(a.cross(b)),
    );
    let sum = weights.x + weights.y + weights.z;
    if weights.min_element() >= 0.0 && sum > 0.0 {
        let weights = weights / sum;
        let foot = a * weights.x + b * weights.y + c * weights.z;
        let distance = foot.length();
        if distance < best.distance {
            best = TrianglePoint {
                barycentric: weights,
                distance,
            };
        }
    }
    best
}

/// The point of segment `a` to `b` nearest to the origin, with its corner weights.
///
/// Computed from the lexicographically smaller end, so that two triangles that share the edge find
/// the same distance in every bit: a tie between them is then a tie.
fn closest_on_edge(a: DVec3, b: DVec3, weights: impl Fn(f64) -> DVec3) -> TrianglePoint {
    let swapped = b.to_array() < a.to_array();
    let (a, b) = if swapped { (b, a) } else { (a, b) };
    let along = b - a;
    let length_sq = along.length_squared();
    let t = if length_sq > 0.0 {
        (-a.dot(along) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    TrianglePoint {
        barycentric: weights(if swapped { 1.0 - t } else { t }),
        // Relative to b in the second half, so that t = 1 gives b itself.
        distance: if t <= 0.5 {
            (a + along * t).length()
        } else {
            (b - along * (1.0 - t)).length()
        },
    }
}

#[test]
#[ignore]
fn old_bits() {
    let mut rng = fastrand::Rng::with_seed(70);
    let n = 6_000_000;
    for case in 0..n {
        let scale = [
            1.0,
            1.0,
            1e-40,
            1e-20,
            1e20,
            (1u128 << 90) as f32,
            (1u128 << 99) as f32,
        ][rng.usize(0..7)];
        let offset = [0.0, 0.0, 1000.0, -0.1][rng.usize(0..4)];
        let t = triangle(&mut rng);
        let p = query(&mut rng, t);
        let snap = case % 5 == 0;
        let place = |p: Vec3| {
            let q = (p + Vec3::splat(offset)) * scale;
            if snap { (p * 2.0).round() * -0.5 } else { q }
        };
        let (t, p) = (t.map(place), place(p));
        let (o, f) = (old_closest_point(t, p), closest_point(t, p));
        let b = |x: &TrianglePoint| {
            [
                x.barycentric.x,
                x.barycentric.y,
                x.barycentric.z,
                x.distance,
            ]
            .map(f64::to_bits)
        };
        assert!(!f.distance.is_nan() && !f.barycentric.is_nan());
        assert_eq!(b(&o), b(&f), "{t:?} {p}");
    }
    println!("{n} cases equal");
}

#[test]
#[ignore]
fn timing() {
    let mut rng = fastrand::Rng::with_seed(71);
    let n = 1024;
    let tris: Vec<[Vec3; 3]> = (0..n * 8)
        .map(|_| {
            let a = random_point(&mut rng);
            [
                a,
                a + random_point(&mut rng) * 0.1,
                a + random_point(&mut rng) * 0.1,
            ]
        })
        .collect();
    let eights: Vec<Corners8> = tris
        .chunks(8)
        .map(|c| {
            let mut e = Corners8::default();
            for (l, t) in c.iter().enumerate() {
                e.set(l, *t);
            }
            e
        })
        .collect();
    let (p, q) = (Vec3::new(0.3, 0.2, 0.1), Vec3::new(0.4, 0.9, 0.1));
    let best = |f: &mut dyn FnMut() -> f64| {
        let mut best = f64::INFINITY;
        for _ in 0..60 {
            let s = Instant::now();
            black_box(f());
            best = best.min(s.elapsed().as_secs_f64());
        }
        best / (n * 8) as f64 * 1e9
    };
    println!(
        "old scalar point {:.1} ns",
        best(&mut || tris.iter().map(|t| old_closest_point(*t, p).distance).sum())
    );
    println!(
        "scalar point {:.1} ns",
        best(&mut || tris.iter().map(|t| closest_point(*t, p).distance).sum())
    );
    println!(
        "scalar segment {:.1} ns",
        best(&mut || tris
            .iter()
            .map(|t| closest_to_segment(*t, p, q).distance)
            .sum())
    );
    println!(
        "gather {:.1} ns",
        best(&mut || tris
            .chunks(8)
            .map(|c| {
                let mut e = Corners8::default();
                for (l, t) in c.iter().enumerate() {
                    e.set(l, *t);
                }
                black_box(&e).x[0][0] as f64
            })
            .sum())
    );
    for level in SimdLevel::available() {
        println!(
            "{level} point {:.1} ns",
            best(&mut || eights
                .iter()
                .map(|e| closest_points(level, e, p).distance[3])
                .sum())
        );
        println!(
            "{level} segment {:.1} ns",
            best(&mut || eights
                .iter()
                .map(|e| closest_to_segments(level, e, p, q).distance[3])
                .sum())
        );
    }
    let ray = ShearedRay::new(&Ray::new(p, q - p).unwrap());
    println!(
        "ray {:.1} ns",
        best(&mut || tris
            .iter()
            .map(|t| ray.intersect(*t, 1e9).map_or(0.0, |f| f.distance))
            .sum())
    );
}
