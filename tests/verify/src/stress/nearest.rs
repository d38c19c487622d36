//! Checks closest points against all triangles in f64, by independent arithmetic.

use crate::brute_force::distance;

use super::posed::Posed;

/// Checks `count` closest points, at several distances from the skin; returns `count`.
pub(super) fn check(posed: &Posed<'_>, rng: &mut fastrand::Rng, count: usize) -> usize {
    for _ in 0..count {
        let off = [0.0, 0.001, 0.05, 3.0][rng.usize(0..4)];
        let mut aims = posed.aims(rng);
        let skin = aims.skin();
        let point = aims.off(skin, off);
        let space = posed.surface.in_model();
        let Some(found) = space.closest_point(point, f32::INFINITY) else {
            panic!("no closest point to {point}");
        };
        let p = point.as_dvec3();
        let triangles = posed.triangles.iter();
        let distances =
            triangles.map(|corners| distance(p, &corners.map(|corner| corner.as_dvec3())));
        let nearest = distances.fold(f64::INFINITY, f64::min);
        // A measure of the lengths involved, to which the rounding error is proportional.
        let size = f64::from(posed.farthest) + p.length();
        let lost = size * 1e-11;
        let off = (found.distance - nearest).abs();
        assert!(
            off <= lost,
            "closest to {point}: {found:?}, but the distance is {nearest}"
        );
    }
    count
}
