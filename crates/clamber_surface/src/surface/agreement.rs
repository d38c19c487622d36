//! For tests: compares every query of a surface with brute force, bit for bit.

mod bits;

pub(crate) use bits::assert_same_bits;

use super::{CastOptions, MovingTriangle, SkinnedSurface, SurfaceHit, SurfacePoint, SweepHit};
use crate::geometry::{Capsule, Ray};
use crate::measure::BruteForce;
use crate::testing::{direction, point};
use glam::Vec3;

/// Compares all queries at seeded random places near the surface and far from it; returns the number of hits.
pub(crate) fn assert_queries_agree(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    rounds: usize,
) -> usize {
    let space = surface.in_model();
    let brute_force = BruteForce::new(space);
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
            let case = format!("{ray:?} {reach}");
            let hit = space.cast_ray(&ray, reach);
            let wanted = brute_force.cast_ray(&ray, reach);
            assert_same_bits(hit.as_slice(), wanted.as_slice(), &case);
            assert_eq!(
                space.intersects_ray(&ray, reach),
                wanted.is_some(),
                "{case}"
            );
            space.cast_ray_all(&ray, reach, &mut hits);
            brute_force.cast_ray_all(&ray, reach, &mut expected);
            assert_same_bits(&hits, &expected, &case);
            assert_same_bits(hit.as_slice(), hits.first().copied().as_slice(), &case);
            found += hits.len();
        }
        let closest = space.closest_point(origin, reach);
        let wanted = brute_force.closest_point(origin, reach);
        let case = format!("{origin} {reach}");
        assert_same_bits(closest.as_slice(), wanted.as_slice(), &case);
        found += usize::from(closest.is_some());
        let radius = if reach.is_finite() { reach } else { size * 0.8 };
        let end = origin + point(rng, size * 0.3);
        let shapes = [
            Capsule::ball(origin, radius),
            Capsule::new(origin, end, radius * 0.5),
        ];
        for capsule in shapes.into_iter().flatten() {
            space.overlap_capsule(&capsule, &mut hits);
            brute_force.overlap_capsule(&capsule, &mut expected);
            let case = format!("{capsule:?} {reach}");
            assert_same_bits(&hits, &expected, &case);
            found += hits.len();
            let closest = space.closest_to_capsule(&capsule, reach);
            let wanted = brute_force.closest_to_capsule(&capsule, reach);
            assert_same_bits(closest.as_slice(), wanted.as_slice(), &case);
            found += assert_casts_agree(&brute_force, surface, rng, &capsule);
        }
        found += assert_boxes_agree(&brute_force, surface, origin, point(rng, size * 0.2));
    }
    found
}

/// Compares the triangles in the box around a point. Half of all boxes have `low` above `high` and hold nothing.
fn assert_boxes_agree(
    brute_force: &BruteForce<'_>,
    surface: &SkinnedSurface,
    center: Vec3,
    half: Vec3,
) -> usize {
    let half = half.with_y(half.y.abs()).with_z(half.z.abs());
    let (low, high) = (center - half, center + half);
    let (mut found, mut expected): (Vec<MovingTriangle>, Vec<MovingTriangle>) = Default::default();
    surface.in_model().visit_box(low, high, |t| found.push(*t));
    brute_force.visit_box(low, high, |t| expected.push(*t));
    found.sort_unstable_by_key(|moving| moving.triangle);
    assert_same_bits(&found, &expected, &format!("box {low} {high}"));
    found.len()
}

/// Compares casts of a capsule at skin that stands still and at skin that moves.
fn assert_casts_agree(
    brute_force: &BruteForce<'_>,
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    capsule: &Capsule,
) -> usize {
    let (space, positions) = (surface.in_model(), brute_force.positions());
    let aim = positions[rng.usize(0..positions.len())] - capsule.ends()[0];
    let aim = aim * [0.0, 0.5, 1.1, 3.0][rng.usize(0..4)];
    let turn = [0.0, 0.5][rng.usize(0..2)];
    let displacements = [aim, aim + point(rng, aim.length() * turn)];
    let tolerance = [None, Some(0.0), Some(1e-5), Some(1e-2), Some(1.0)][rng.usize(0..5)];
    let mut found = 0;
    let (mut hits, mut expected): (Vec<SweepHit>, Vec<SweepHit>) = Default::default();
    for mut options in [CastOptions::STILL, CastOptions::MOVING] {
        options.tolerance = tolerance.map(|share: f32| f64::from(capsule.radius() * share));
        let case = format!("{capsule:?} {displacements:?} {options:?}");
        let hit = space.cast_capsule(capsule, displacements, &options);
        let wanted = brute_force.cast_capsule(capsule, displacements, &options);
        assert_same_bits(hit.as_slice(), wanted.as_slice(), &case);
        space.cast_capsule_all(capsule, displacements, &options, &mut hits);
        brute_force.cast_capsule_all(capsule, displacements, &options, &mut expected);
        assert_same_bits(&hits, &expected, &case);
        assert_same_bits(hit.as_slice(), hits.first().copied().as_slice(), &case);
        // Among some contacts only: those that do not start inside, and every third triangle.
        let counts = [
            |hit: &SweepHit| !hit.started_inside,
            |hit: &SweepHit| hit.triangle.0.is_multiple_of(3),
        ];
        for counts in counts {
            let shown = &mut |hit: &SweepHit| counts(hit);
            let hit = space.cast_capsule_where(capsule, displacements, &options, shown);
            let wanted = hits.iter().copied().find(counts);
            assert_same_bits(hit.as_slice(), wanted.as_slice(), &case);
        }
        found += hits.len();
    }
    found
}

/// The results of all queries at one place: points and normals, each with a distance or a time.
pub(crate) fn answers(
    surface: &SkinnedSurface,
    place: Vec3,
    towards: Vec3,
    reach: f32,
) -> Vec<(SurfacePoint, Vec3, f64)> {
    let space = surface.in_model();
    let (mut all, mut hits): (Vec<SurfaceHit>, Vec<SurfaceHit>) = Default::default();
    if let Some(ray) = Ray::new(place, towards) {
        all.extend(space.cast_ray(&ray, reach));
        space.cast_ray_all(&ray, reach, &mut hits);
        all.append(&mut hits);
    }
    all.extend(space.closest_point(place, reach));
    let mut swept = Vec::new();
    let shapes = [
        Capsule::ball(place, reach.min(f32::MAX)),
        Capsule::new(place, place + towards, reach.min(f32::MAX) * 0.5),
    ];
    for capsule in shapes.into_iter().flatten() {
        space.overlap_capsule(&capsule, &mut hits);
        all.append(&mut hits);
        let closest = space.closest_to_capsule(&capsule, reach);
        all.extend(closest.map(|hit| hit.surface));
        if reach.is_infinite() {
            continue;
        }
        let motions = [towards, Vec3::ZERO];
        swept.extend(space.cast_capsule(&capsule, motions, &CastOptions::STILL));
        swept.extend(space.cast_capsule(&capsule, [towards; 2], &CastOptions::MOVING));
        let mut contacts = Vec::new();
        space.cast_capsule_all(&capsule, motions, &CastOptions::MOVING, &mut contacts);
        swept.append(&mut contacts);
    }
    let near = all.iter().map(|hit| (hit.into(), hit.normal, hit.distance));
    let met = swept
        .iter()
        .map(|hit| (hit.into(), hit.separation_normal, hit.time));
    near.chain(met).collect()
}
