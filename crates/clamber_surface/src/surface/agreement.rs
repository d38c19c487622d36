//! For tests: every query of a surface against brute force, bit for bit.

use super::{BruteForce, SkinnedSurface, SurfaceHit};
use crate::geometry::{Capsule, Ray, Sphere};
use crate::testing::{direction, point};
use glam::Vec3;

/// Compares at seeded random places near the surface and far from it; gives how many hits there were.
pub(super) fn assert_queries_agree(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    rounds: usize,
) -> usize {
    let brute_force = BruteForce::new(surface);
    let positions = brute_force.positions();
    let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = positions
        .iter()
        .copied()
        .fold(Vec3::NEG_INFINITY, Vec3::max);
    let size = (high - low).max_element();
    let mut found = 0;
    let (mut hits, mut expected): (Vec<SurfaceHit>, Vec<SurfaceHit>) = Default::default();
    for _ in 0..rounds {
        let any = |rng: &mut fastrand::Rng| positions[rng.usize(0..positions.len())];
        let spread = size * [0.0, 0.01, 0.3, 2.0][rng.usize(0..4)];
        let origin = any(rng) + point(rng, spread);
        let aim = match rng.u32(0..3) {
            0 => direction(rng),
            _ => any(rng) - origin,
        };
        let reach = size * [0.0, 0.05, 0.5, f32::INFINITY][rng.usize(0..4)];
        let reach = if size == 0.0 { 1.0 } else { reach };
        if let Some(ray) = Ray::new(origin, aim) {
            let hit = surface.cast_ray(&ray, reach).unwrap();
            let wanted = brute_force.cast_ray(&ray, reach).unwrap();
            assert_eq!(hit, wanted, "{ray:?} {reach}");
            let met = surface.intersects_ray(&ray, reach).unwrap();
            assert_eq!(met, wanted.is_some(), "{ray:?} {reach}");
            surface.cast_ray_all(&ray, reach, &mut hits).unwrap();
            brute_force
                .cast_ray_all(&ray, reach, &mut expected)
                .unwrap();
            assert_eq!(hits, expected, "{ray:?} {reach}");
            found += hits.len();
        }
        let closest = surface.closest_point(origin, reach).unwrap();
        let wanted = brute_force.closest_point(origin, reach).unwrap();
        assert_eq!(closest, wanted, "{origin} {reach}");
        let sphere = Sphere {
            center: origin,
            radius: reach,
        };
        surface.overlap_sphere(&sphere, &mut hits).unwrap();
        brute_force.overlap_sphere(&sphere, &mut expected).unwrap();
        assert_eq!(hits, expected, "{sphere:?}");
        found += usize::from(closest.is_some()) + hits.len();
        let capsule = Capsule {
            a: origin,
            b: origin + point(rng, size * 0.3),
            radius: reach * 0.5,
        };
        surface.overlap_capsule(&capsule, &mut hits).unwrap();
        brute_force
            .overlap_capsule(&capsule, &mut expected)
            .unwrap();
        assert_eq!(hits, expected, "{capsule:?}");
        found += hits.len();
    }
    found
}
