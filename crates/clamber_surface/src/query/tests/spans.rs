//! Casts over a part of the tick.

use crate::SimdLevel;
use crate::geometry::{Similarity, rotation_from_axis_angle};
use crate::measure::BruteForce;
use crate::surface::{CastOptions, SkinnedSurface, SweepHit};
use crate::testing::{ball, bend, capsule, cases, tube};
use fastrand::Rng;
use glam::{DVec3, Vec3};

/// A tube that bends and turns far in this tick.
fn bending(level: SimdLevel, rng: &mut Rng) -> SkinnedSurface {
    let mut surface = SkinnedSurface::with_simd_level(tube(12, 24), level);
    for _ in 0..2 {
        let axis = DVec3::new(1.0, rng.f64(), rng.f64()).normalize();
        let root = Similarity {
            rotation: rotation_from_axis_angle(DVec3::Z, 0.4 * rng.f64()),
            translation: DVec3::new(rng.f64(), rng.f64(), rng.f64()),
            ..Similarity::IDENTITY
        };
        let palette = bend(12, axis, 0.6 * rng.f64());
        surface.advance(&palette, root).unwrap();
        if rng.bool() {
            surface.skin_ahead();
        }
    }
    surface
}

fn place(rng: &mut Rng) -> Vec3 {
    let lot = |rng: &mut Rng, size: f32| size * (2.0 * rng.f32() - 1.0);
    Vec3::new(2.0 + lot(rng, 3.0), lot(rng, 2.0), lot(rng, 2.0))
}

#[test]
fn a_part_of_a_tick_has_the_bits_of_brute_force() {
    let (mut found, mut missed, mut overlapping) = (0, 0, 0);
    for level in SimdLevel::available() {
        let mut rng = Rng::with_seed(11);
        for _ in 0..cases(400) {
            let surface = bending(level, &mut rng);
            let (space, reference) = (surface.in_model(), BruteForce::new(surface.in_model()));
            let stick = match rng.bool() {
                true => capsule(place(&mut rng), place(&mut rng), 0.05),
                false => ball(place(&mut rng), 0.2),
            };
            let way = place(&mut rng) - place(&mut rng);
            let ways = [way, if rng.bool() { way } else { place(&mut rng) }];
            let (a, b) = (rng.f64(), rng.f64());
            let options = [CastOptions::MOVING, CastOptions::STILL][usize::from(rng.u8(0..5) == 0)]
                .during(a.min(b), a.max(b));
            let hit = space.cast_capsule(&stick, ways, &options);
            assert_eq!(hit, reference.cast_capsule(&stick, ways, &options));
            let past = options.past_overlaps();
            let beyond = space.cast_capsule(&stick, ways, &past);
            assert_eq!(beyond, reference.cast_capsule(&stick, ways, &past));
            let mut is_beyond = |hit: &SweepHit| !hit.started_inside;
            let wanted = reference.cast_capsule_where(&stick, ways, &options, &mut is_beyond);
            assert_eq!(beyond, wanted);
            overlapping += usize::from(beyond != hit);
            found += usize::from(hit.is_some());
            missed += usize::from(hit.is_none());

            let (mut all, mut expected) = (Vec::new(), Vec::new());
            for options in [options, past] {
                space.cast_capsule_all(&stick, ways, &options, &mut all);
                reference.cast_capsule_all(&stick, ways, &options, &mut expected);
                assert_eq!(all, expected);
            }
            let mut counts = |hit: &SweepHit| hit.hit.triangle.0.is_multiple_of(3);
            let some = space.cast_capsule_where(&stick, ways, &options, &mut counts);
            let wanted = reference.cast_capsule_where(&stick, ways, &options, &mut counts);
            assert_eq!(some, wanted);
        }
    }
    assert!(
        found > cases(300) && missed > cases(100) && overlapping > cases(50),
        "{found} {missed} {overlapping}"
    );
}

/// Casts over the parts of a motion, one after the other, find the contact that the cast over the whole motion finds.
#[test]
fn a_sweep_in_parts_meets_what_the_whole_sweep_meets() {
    let mut rng = Rng::with_seed(12);
    let mut met = 0;
    for _ in 0..cases(600) {
        let surface = bending(SimdLevel::best(), &mut rng);
        let space = surface.in_model();
        let ends = [place(&mut rng), place(&mut rng)];
        let ways = [
            place(&mut rng) - place(&mut rng),
            place(&mut rng) - place(&mut rng),
        ];
        let at = |share: f64| [0, 1].map(|k| ends[k].as_dvec3() + ways[k].as_dvec3() * share);
        let whole =
            space.cast_capsule(&capsule(ends[0], ends[1], 0.05), ways, &CastOptions::MOVING);
        let parts = rng.u32(1..9);
        let in_parts = (0..parts).find_map(|part| {
            let [from, to] = [part, part + 1].map(|k| f64::from(k) / f64::from(parts));
            let ([a, b], after) = (at(from).map(|p| p.as_vec3()), at(to));
            let ways = [after[0] - a.as_dvec3(), after[1] - b.as_dvec3()].map(|way| way.as_vec3());
            let options = CastOptions::MOVING.during(from, to);
            let hit = space.cast_capsule(&capsule(a, b, 0.05), ways, &options)?;
            Some((from + (to - from) * hit.fraction, hit.started_inside))
        });
        // Times are never late. Except in grazing contacts, they are early by at most the time in which the tolerance
        // is passed.
        match (whole, in_parts) {
            (Some(hit), Some((time, _))) => {
                met += 1;
                assert!(
                    (hit.fraction - time).abs() < 2e-3,
                    "{hit:?}, in parts at {time}"
                );
            }
            (None, None) => {}
            (Some(hit), None) => assert!(hit.hit.distance > 0.05, "{hit:?}"),
            (None, Some((_, inside))) => assert!(!inside, "inside of what the whole missed"),
        }
    }
    assert!(met > cases(150), "{met}");
}

#[test]
fn a_part_that_is_none_finds_nothing() {
    let surface = SkinnedSurface::new(tube(4, 12));
    let stick = capsule(Vec3::new(1.5, 3.0, 0.0), Vec3::new(1.6, 3.0, 0.0), 0.1);
    let cast = |from, to| {
        let options = CastOptions::MOVING.during(from, to);
        let space = surface.in_model();
        space.cast_capsule(&stick, [Vec3::NEG_Y * 4.0; 2], &options)
    };
    assert!(cast(0.25, 0.5).is_some());
    for (from, to) in [
        (0.5, 0.25),
        (-0.1, 0.5),
        (0.0, 1.5),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
    ] {
        assert_eq!(cast(from, to), None, "{from} {to}");
    }
}
