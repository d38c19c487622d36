//! Every query at one place, compared with brute force.

use glam::Vec3;

use crate::geometry::{Capsule, Ray};
use crate::measure::BruteForce;
use crate::mesh::TriangleId;
use crate::surface::{SkinnedSurface, SurfaceHit};

/// The place and size of a query.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) origin: Vec3,
    /// Direction of the ray, and vector from `origin` to the other end of the capsule.
    pub(super) towards: Vec3,
    pub(super) reach: f32,
}

/// Compares the overlaps of a capsule with brute force, and returns them.
pub(super) fn overlaps(
    surface: &SkinnedSurface,
    brute_force: &BruteForce<'_>,
    capsule: &Capsule,
    case: &str,
) -> Vec<SurfaceHit> {
    let (mut hits, mut wanted) = (Vec::new(), Vec::new());
    surface.in_model().overlap_capsule(capsule, &mut hits);
    brute_force.overlap_capsule(capsule, &mut wanted);
    assert_eq!(hits, wanted, "{case}: overlap_capsule, {capsule:?}");
    hits
}

/// [`overlaps`], compared also with the triangles in the capsule; returns their number.
pub(super) fn assert_overlaps_agree(
    surface: &SkinnedSurface,
    brute_force: &BruteForce<'_>,
    capsule: &Capsule,
    case: &str,
) -> usize {
    let hits = overlaps(surface, brute_force, capsule, case);
    let mut triangles = Vec::new();
    let space = surface.in_model();
    space.visit_triangles_in_capsule(capsule, |triangle| triangles.push(triangle));
    triangles.sort_unstable();
    let wanted: Vec<TriangleId> = hits.iter().map(|hit| hit.triangle).collect();
    assert_eq!(triangles, wanted, "{case}: triangles, {capsule:?}");
    hits.len()
}

/// Compares every query at a place; returns the number of hits.
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
        let hit = surface.in_model().cast_ray(&ray, reach);
        let expected = brute_force.cast_ray(&ray, reach);
        assert_eq!(hit, expected, "{case}: cast_ray, {place:?}");
        let met = surface.in_model().intersects_ray(&ray, reach);
        assert_eq!(met, expected.is_some(), "{case}: intersects, {place:?}");
        surface.in_model().cast_ray_all(&ray, reach, &mut hits);
        brute_force.cast_ray_all(&ray, reach, &mut wanted);
        assert_eq!(hits, wanted, "{case}: cast_ray_all, {place:?}");
        found += hits.len();
    }
    let closest = surface.in_model().closest_point(origin, reach);
    let expected = brute_force.closest_point(origin, reach);
    assert_eq!(closest, expected, "{case}: closest_point, {place:?}");
    found += usize::from(closest.is_some());
    let radius = reach.min(f32::MAX);
    let shapes = [
        Capsule::ball(origin, radius),
        Capsule::new(origin, origin + towards, radius),
    ];
    for capsule in shapes.into_iter().flatten() {
        found += assert_overlaps_agree(surface, brute_force, &capsule, case);
    }
    found
}
