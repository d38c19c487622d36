//! Triangles and queries that have broken such tests before, mixed with plain ones.

use glam::Vec3;

use crate::testing::point;

pub(super) fn lerp(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

/// A triangle of about unit size: plain, a sliver of height 1e-1 to 1e-7, a needle, Catto's
/// troublesome one, a segment, a point.
pub(super) fn triangle(rng: &mut fastrand::Rng) -> [Vec3; 3] {
    let [a, b, c] = [(); 3].map(|()| point(rng, 1.0));
    let mut corners = match rng.u32(0..8) {
        0 | 1 => [a, b, c],
        2 | 3 => {
            let height = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7][rng.usize(0..7)];
            let along = rng.f32() * 1.4 - 0.2;
            [a, b, lerp(a, b, along) + (c - a) * height]
        }
        4 => [a, b, a + c * 1e-5],
        5 => [
            // Catto: a normal in f32 keeps two digits.
            Vec3::new(0.331_916_57, 0.382_771_94, -0.465_963_87),
            Vec3::new(0.378_853_9, -0.246_981_59, -0.440_359_06),
            Vec3::new(0.331_879_08, 0.382_861_08, -0.465_974),
        ],
        6 => [a, b, [a, b, lerp(a, b, 0.5)][rng.usize(0..3)]],
        _ => [[a, a, a], [a, b, c].map(|p| Vec3::new(p.x, p.y, 0.0))][rng.usize(0..2)],
    };
    corners.rotate_left(rng.usize(0..3));
    if rng.bool() {
        corners.swap(0, 1);
    }
    corners
}

/// A query point: on a corner, on an edge, on the face, near it, or anywhere.
pub(super) fn query(rng: &mut fastrand::Rng, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let inside = lerp(a, lerp(b, c, rng.f32()), rng.f32());
    match rng.u32(0..8) {
        0 => a,
        1 => lerp(b, c, rng.f32()),
        2 => inside,
        3 => inside + point(rng, 1e-6),
        4 => lerp(a, b, rng.f32() * 3.0 - 1.0),
        _ => point(rng, 2.0),
    }
}

/// A query segment: through the face, one end on a feature, parallel to an edge, in the plane, of zero length, or
/// anywhere.
pub(super) fn segment(rng: &mut fastrand::Rng, corners: [Vec3; 3]) -> [Vec3; 2] {
    let [a, b, c] = corners;
    let (p, q) = (query(rng, corners), query(rng, corners));
    let inside = lerp(a, lerp(b, c, rng.f32()), rng.f32());
    let size = [1.0, 1e-3, 1e-6][rng.usize(0..3)];
    let shift = point(rng, size);
    match rng.u32(0..8) {
        0 => [p, p],
        1 => [a + shift, b + shift],
        2 => [lerp(a, b, -0.5) + shift, lerp(a, b, 0.7) + shift],
        3 => [inside + shift, inside - shift * 0.7],
        4 => [lerp(a, b, rng.f32()), lerp(a, c, rng.f32() * 2.0)],
        5 => [p, lerp(p, inside, 2.0)],
        _ => [p, q],
    }
}

/// The points displaced by `offset`, rounded to f32.
pub(super) fn moved<const N: usize>(points: [Vec3; N], offset: Vec3) -> [Vec3; N] {
    points.map(|p| p + offset)
}
