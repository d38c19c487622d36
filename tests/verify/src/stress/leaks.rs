//! Checks that no ray gets through closed skin.
//!
//! A path between two points with different winding numbers crosses the skin, however the skin is bent, mirrored or
//! pinched. This follows from topology alone, without any query. The winding number of a point is the sum of the solid
//! angles of the triangles over 4 pi (van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle"), here in
//! f64, independently of the library's own.

use crate::agreement::{Answers, Question};
use crate::brute_force::distance;
use clamber_surface::geometry::Ray;
use glam::{DVec3, Vec3};

use super::posed::Posed;

/// Largest distance of a computed winding number from a whole number. A number farther off is not used.
const ROUNDED: f64 = 1e-3;

/// Rounding of a ray test in f32 acts like moving the vertices by at most this share of the lengths involved. The value
/// includes a margin.
const MOVED: f64 = 1e-6;

/// The winding number of closed skin around a point. `None` near the skin, where moving the skin by rounding could move
/// it across the point. Elsewhere such a motion does not change the winding number.
fn winding(posed: &Posed<'_>, point: DVec3) -> Option<i64> {
    let clear = MOVED * (f64::from(posed.farthest) + point.length());
    let mut sum = 0.0;
    for triangle in 0..posed.surface.mesh().triangles().len() {
        let corners = posed.triangles[triangle].map(|p| p.as_dvec3() - point);
        if distance(DVec3::ZERO, &corners) < clear {
            return None;
        }
        let [a, b, c] = corners;
        let (x, y, z) = (a.length(), b.length(), c.length());
        let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        sum += 2.0 * libm::atan2(a.dot(b.cross(c)), below);
    }
    let turns = sum / (4.0 * core::f64::consts::PI);
    let whole = turns.round();
    ((turns - whole).abs() < ROUNDED).then_some(whole as i64)
}

/// Aims rays at edges, vertices and triangles from either side; returns the number of rays that had to hit.
pub(super) fn check(posed: &Posed<'_>, rng: &mut fastrand::Rng, origins: usize) -> usize {
    let mut checked = 0;
    for _ in 0..origins {
        let origin = origin(posed, rng);
        let Some(around) = winding(posed, origin.as_dvec3()) else {
            continue;
        };
        for kind in 0..6 {
            let mut aims = posed.aims(rng);
            let target = match kind % 3 {
                0 => aims.edge(),
                1 => aims.vertex(),
                _ => aims.skin(),
            };
            let Some(ray) = Ray::new(origin, target - origin) else {
                continue;
            };
            if around != 0 {
                must_hit(posed, [origin, target - origin], f32::INFINITY);
                checked += 1;
            }
            // A ray that ends just beyond its target on the skin.
            let beyond = libm::exp10(-4.0 + 3.0 * rng.f64()) * f64::from(posed.extent);
            let reach = (target - origin).as_dvec3().length() + beyond;
            let end = origin.as_dvec3() + ray.direction().as_dvec3() * reach;
            if winding(posed, end).is_some_and(|there| there != around) {
                must_hit(
                    posed,
                    [origin, target - origin],
                    (reach * (1.0 + 1e-6)) as f32,
                );
                checked += 1;
            }
        }
    }
    checked
}

/// A point close to the skin, on either side.
fn origin(posed: &Posed<'_>, rng: &mut fastrand::Rng) -> Vec3 {
    let triangle = posed.any_triangle(rng);
    let [a, b, c] = posed.triangles[triangle].map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or(DVec3::X);
    let side = if rng.bool() { 1.0 } else { -1.0 };
    let off = libm::exp10(-3.0 + 2.5 * rng.f64()) * f64::from(posed.extent);
    ((a + b + c) / 3.0 + normal * (side * off)).as_vec3()
}

fn must_hit(posed: &Posed<'_>, [origin, direction]: [Vec3; 2], max_distance: f32) {
    for question in Question::along_ray(origin, direction, max_distance) {
        let mut found = Vec::new();
        posed.surface.in_model().answer(&question, &mut found);
        assert!(!found.is_empty(), "a leak: {question:?} finds nothing");
    }
}
