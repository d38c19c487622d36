//! What is said to be nearest is: against all triangles in f64, by arithmetic of its own.

use super::aims::Aims;
use super::posed::{Posed, nearest_in};

/// Asks at some distances from the skin; gives how often.
pub(super) fn check(posed: &Posed<'_>, rng: &mut fastrand::Rng, count: usize) -> usize {
    for _ in 0..count {
        let off = [0.0, 0.001, 0.05, 3.0][rng.usize(0..4)];
        let mut aims = Aims::new(posed, rng);
        let skin = aims.skin();
        let point = aims.off(skin, off);
        let space = posed.surface.in_model();
        let Some(found) = space.closest_point(point, f32::INFINITY) else {
            panic!("nothing is nearest to {point}");
        };
        let p = point.as_dvec3();
        let triangles = 0..posed.surface.mesh().triangles().len();
        let distances = triangles.map(|triangle| {
            let corners = posed.corners(triangle).map(|corner| corner.as_dvec3());
            (nearest_in(corners, p) - p).length()
        });
        let nearest = distances.fold(f64::INFINITY, f64::min);
        // The lengths involved are of this size.
        let size = f64::from(posed.farthest) + p.length();
        let lost = size * 1e-11;
        let off = (found.distance - nearest).abs();
        assert!(
            off <= lost,
            "nearest to {point}: {found:?}, but {nearest} away"
        );
    }
    count
}
