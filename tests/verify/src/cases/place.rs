//! Random places and directions.

use glam::DVec3;

/// A random point with coordinates from -1 to 1.
pub(super) fn point(rng: &mut fastrand::Rng) -> DVec3 {
    let mut coordinate = || rng.f64() * 2.0 - 1.0;
    DVec3::new(coordinate(), coordinate(), coordinate())
}

/// A random unit vector.
pub(super) fn direction(rng: &mut fastrand::Rng) -> DVec3 {
    loop {
        let p = point(rng);
        if (0.01..=1.0).contains(&p.length_squared()) {
            return p.normalize();
        }
    }
}

/// A random unit vector perpendicular to the unit vector `n`.
pub(super) fn across(rng: &mut fastrand::Rng, n: DVec3) -> DVec3 {
    let p = direction(rng);
    (p - n * n.dot(p))
        .try_normalize()
        .unwrap_or(n.any_orthonormal_vector())
}

/// `p` turned about a unit axis through the origin (Rodrigues' formula).
pub(super) fn turned(p: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    p * cos + axis.cross(p) * sin + axis * (axis.dot(p) * (1.0 - cos))
}
