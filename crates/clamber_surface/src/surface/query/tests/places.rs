//! One place, every query, against brute force.

use glam::Vec3;

use crate::geometry::{Capsule, Ray, Sphere};
use crate::surface::{BruteForce, SkinnedSurface, SurfaceHit};

/// Where a query stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) origin: Vec3,
    /// Where its ray goes, and from `origin` to the other end of its capsule.
    pub(super) towards: Vec3,
    pub(super) reach: f32,
}

/// Compares every query at a place; gives how many hits there were.
pub(super) fn assert_agree(
    surface: &SkinnedSurface,
    brute_force: &BruteForce<'_>,
    place: Place,
    case: &str,
) -> usize {
    let Place {
        origin,
        towards,
        reach,
    } = place;
    let (mut hits, mut wanted): (Vec<SurfaceHit>, Vec<SurfaceHit>) = Default::default();
    let mut found = 0;
    if let Some(ray) = Ray::new(origin, towards) {
        let hit = surface.cast_ray(&ray, reach).unwrap();
        let expected = brute_force.cast_ray(&ray, reach).unwrap();
        assert_eq!(hit, expected, "{case}: cast_ray, {place:?}");
        let met = surface.intersects_ray(&ray, reach).unwrap();
        assert_eq!(met, expected.is_some(), "{case}: intersects, {place:?}");
        surface.cast_ray_all(&ray, reach, &mut hits).unwrap();
        brute_force.cast_ray_all(&ray, reach, &mut wanted).unwrap();
        assert_eq!(hits, wanted, "{case}: cast_ray_all, {place:?}");
        found += hits.len();
    }
    let closest = surface.closest_point(origin, reach).unwrap();
    let expected = brute_force.closest_point(origin, reach).unwrap();
    assert_eq!(closest, expected, "{case}: closest_point, {place:?}");
    let sphere = Sphere {
        center: origin,
        radius: reach,
    };
    surface.overlap_sphere(&sphere, &mut hits).unwrap();
    brute_force.overlap_sphere(&sphere, &mut wanted).unwrap();
    assert_eq!(hits, wanted, "{case}: overlap_sphere, {place:?}");
    found += usize::from(closest.is_some()) + hits.len();
    let b = origin + towards;
    if b.is_finite() {
        let capsule = Capsule {
            a: origin,
            b,
            radius: reach,
        };
        surface.overlap_capsule(&capsule, &mut hits).unwrap();
        brute_force.overlap_capsule(&capsule, &mut wanted).unwrap();
        assert_eq!(hits, wanted, "{case}: overlap_capsule, {capsule:?}");
        found += hits.len();
    }
    found
}
