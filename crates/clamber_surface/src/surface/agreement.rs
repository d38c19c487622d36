//! For tests: every query of a surface against brute force, bit for bit.

mod bits;

pub(super) use bits::assert_same_bits;

use super::{BruteForce, MovingTriangle, SkinnedSurface, SurfaceHit, SweepHit};
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
            let case = format_args!("{ray:?} {reach}");
            assert_same_bits(hit.as_slice(), wanted.as_slice(), case);
            let met = surface.intersects_ray(&ray, reach).unwrap();
            assert_eq!(met, wanted.is_some(), "{ray:?} {reach}");
            surface.cast_ray_all(&ray, reach, &mut hits).unwrap();
            brute_force
                .cast_ray_all(&ray, reach, &mut expected)
                .unwrap();
            assert_same_bits(&hits, &expected, format_args!("{ray:?} {reach}"));
            let first = hits.first().copied();
            assert_same_bits(
                hit.as_slice(),
                first.as_slice(),
                format_args!("{ray:?} {reach}"),
            );
            found += hits.len();
        }
        let closest = surface.closest_point(origin, reach).unwrap();
        let wanted = brute_force.closest_point(origin, reach).unwrap();
        let case = format_args!("{origin} {reach}");
        assert_same_bits(closest.as_slice(), wanted.as_slice(), case);
        let sphere = Sphere {
            center: origin,
            radius: reach,
        };
        surface.overlap_sphere(&sphere, &mut hits).unwrap();
        brute_force.overlap_sphere(&sphere, &mut expected).unwrap();
        assert_same_bits(&hits, &expected, format_args!("{sphere:?}"));
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
        assert_same_bits(&hits, &expected, format_args!("{capsule:?}"));
        found += hits.len();
        let closest = surface.closest_to_capsule(&capsule, reach).unwrap();
        let wanted = brute_force.closest_to_capsule(&capsule, reach).unwrap();
        let case = format_args!("{capsule:?} {reach}");
        assert_same_bits(closest.as_slice(), wanted.as_slice(), case);
        found += assert_sweeps_agree(&brute_force, surface, rng, &capsule);
        found += assert_boxes_agree(&brute_force, surface, origin, point(rng, size * 0.2));
    }
    found
}

/// Compares what is in the box around a point; half of all boxes are inside out, and hold nothing.
fn assert_boxes_agree(
    brute_force: &BruteForce<'_>,
    surface: &SkinnedSurface,
    center: Vec3,
    half: Vec3,
) -> usize {
    let half = half.with_y(half.y.abs()).with_z(half.z.abs());
    let (low, high) = (center - half, center + half);
    if !(low.is_finite() && high.is_finite()) {
        return 0;
    }
    let (mut found, mut expected): (Vec<MovingTriangle>, Vec<MovingTriangle>) = Default::default();
    surface.visit_box(low, high, |t| found.push(*t)).unwrap();
    brute_force
        .visit_box(low, high, |t| expected.push(*t))
        .unwrap();
    found.sort_unstable_by_key(|moving| moving.triangle);
    assert_same_bits(&found, &expected, format_args!("box {low} {high}"));
    found.len()
}

/// Compares casts and sweeps of a capsule, and of the sphere about one of its ends.
fn assert_sweeps_agree(
    brute_force: &BruteForce<'_>,
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    capsule: &Capsule,
) -> usize {
    let positions = brute_force.positions();
    let aim = positions[rng.usize(0..positions.len())] - capsule.a;
    let aim = aim * [0.0, 0.5, 1.1, 3.0][rng.usize(0..4)];
    let radius = if capsule.radius.is_finite() {
        capsule.radius
    } else {
        aim.length() * 0.1
    };
    let tolerance = radius * [0.0, 1e-5, 1e-2, 1.0][rng.usize(0..4)];
    let sphere = Sphere {
        center: capsule.a,
        radius,
    };
    let capsule = Capsule { radius, ..*capsule };
    let turn = [0.0, 0.5][rng.usize(0..2)];
    let turn = point(rng, aim.length() * turn);
    let motions = [aim, aim + turn];
    if !(motions[1].is_finite() && radius.is_finite() && capsule.b.is_finite()) {
        return 0;
    }
    let case = format_args!("{capsule:?} {motions:?} {tolerance}");

    let hit = surface.cast_sphere(&sphere, aim, tolerance).unwrap();
    let wanted = brute_force.cast_sphere(&sphere, aim, tolerance).unwrap();
    assert_same_bits(
        hit.as_slice(),
        wanted.as_slice(),
        format_args!("cast sphere, {case}"),
    );
    let hit = surface.cast_capsule(&capsule, motions, tolerance).unwrap();
    let wanted = brute_force
        .cast_capsule(&capsule, motions, tolerance)
        .unwrap();
    assert_same_bits(
        hit.as_slice(),
        wanted.as_slice(),
        format_args!("cast capsule, {case}"),
    );

    let (mut hits, mut expected): (Vec<SweepHit>, Vec<SweepHit>) = Default::default();
    let mut found = 0;
    let hit = surface.sweep_sphere(&sphere, aim, tolerance).unwrap();
    surface
        .sweep_sphere_all(&sphere, aim, tolerance, &mut hits)
        .unwrap();
    brute_force
        .sweep_sphere_all(&sphere, aim, tolerance, &mut expected)
        .unwrap();
    assert_same_bits(&hits, &expected, format_args!("sweep sphere, {case}"));
    assert_same_bits(
        hit.as_slice(),
        hits.first().copied().as_slice(),
        format_args!("first of sweep sphere, {case}"),
    );
    // Among some only: those that do not start inside, and every third triangle.
    let counts = [
        |hit: &SweepHit| !hit.started_inside,
        |hit: &SweepHit| hit.triangle.0.is_multiple_of(3),
    ];
    for counts in counts {
        let hit = surface.sweep_sphere_where(&sphere, aim, tolerance, &mut |hit| counts(hit));
        let wanted = hits.iter().copied().find(counts);
        assert_same_bits(
            hit.unwrap().as_slice(),
            wanted.as_slice(),
            format_args!("first that counts of sweep sphere, {case}"),
        );
    }
    found += hits.len();
    let hit = surface.sweep_capsule(&capsule, motions, tolerance).unwrap();
    surface
        .sweep_capsule_all(&capsule, motions, tolerance, &mut hits)
        .unwrap();
    brute_force
        .sweep_capsule_all(&capsule, motions, tolerance, &mut expected)
        .unwrap();
    assert_same_bits(&hits, &expected, format_args!("sweep capsule, {case}"));
    assert_same_bits(
        hit.as_slice(),
        hits.first().copied().as_slice(),
        format_args!("first of sweep capsule, {case}"),
    );
    for counts in counts {
        let hit = surface.sweep_capsule_where(&capsule, motions, tolerance, &mut |hit| counts(hit));
        let wanted = hits.iter().copied().find(counts);
        assert_same_bits(
            hit.unwrap().as_slice(),
            wanted.as_slice(),
            format_args!("first that counts of sweep capsule, {case}"),
        );
    }
    found + hits.len()
}

/// All answers at one place.
pub(super) fn answers(
    surface: &SkinnedSurface,
    place: Vec3,
    towards: Vec3,
    reach: f32,
) -> Vec<SurfaceHit> {
    let mut all = Vec::new();
    let mut hits = Vec::new();
    if let Some(ray) = Ray::new(place, towards) {
        all.extend(surface.cast_ray(&ray, reach).unwrap());
        surface.cast_ray_all(&ray, reach, &mut hits).unwrap();
        all.append(&mut hits);
    }
    all.extend(surface.closest_point(place, reach).unwrap());
    let sphere = Sphere {
        center: place,
        radius: reach,
    };
    surface.overlap_sphere(&sphere, &mut hits).unwrap();
    all.append(&mut hits);
    let capsule = Capsule {
        a: place,
        b: place + towards,
        radius: reach * 0.5,
    };
    surface.overlap_capsule(&capsule, &mut hits).unwrap();
    all.append(&mut hits);
    let closest = surface.closest_to_capsule(&capsule, reach).unwrap();
    all.extend(closest.map(|hit| hit.surface));
    if reach.is_finite() {
        let mut swept = Vec::new();
        let (sphere, tolerance) = (
            Sphere {
                radius: reach * 0.1,
                ..sphere
            },
            reach * 1e-3,
        );
        surface
            .sweep_sphere_all(&sphere, towards, tolerance, &mut swept)
            .unwrap();
        swept.extend(surface.sweep_sphere(&sphere, towards, tolerance).unwrap());
        let motions = [towards, Vec3::ZERO];
        swept.extend(surface.cast_capsule(&capsule, motions, tolerance).unwrap());
        all.extend(swept.iter().map(as_surface_hit));
    }
    all
}

/// With the time in place of the distance.
fn as_surface_hit(hit: &SweepHit) -> SurfaceHit {
    SurfaceHit {
        triangle: hit.triangle,
        barycentric: hit.barycentric,
        point: hit.point,
        normal: hit.normal,
        distance: hit.time as f32,
        part: hit.part,
        tag: hit.tag,
    }
}
