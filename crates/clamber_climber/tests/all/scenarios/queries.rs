//! Queries of surfaces and bodies through the trait `Obstacle`, as a climber makes them.

use clamber_verify::brute_force::{Triangles, distance, segment_distance};
use clamber_world::rapier3d::prelude::ColliderBuilder;
use clamber_world::{Contact, Obstacle, SweepContact, TargetMotion, WorldCapsule};
use glam::DVec3;

use crate::cases::pairs;
use crate::stage::{Played, Shape, Stage, kinds, shifted, within};

/// All motions of a target.
const TARGETS: [TargetMotion; 2] = [TargetMotion::Still, TargetMotion::Moving];

/// Queries the only obstacle of a stage.
fn ask<T>(stage: &Stage, question: impl FnOnce(&dyn Obstacle) -> T) -> T {
    stage.obstacles(|obstacles| question(obstacles[0].1))
}

fn cast(
    stage: &Stage,
    capsule: &WorldCapsule,
    way: DVec3,
    target: TargetMotion,
) -> Option<SweepContact> {
    ask(stage, |obstacle| {
        obstacle.cast_capsule(capsule, [way; 2], target)
    })
}

fn overlaps(stage: &Stage, capsule: &WorldCapsule) -> Vec<Contact> {
    let mut contacts = Vec::new();
    ask(stage, |obstacle| {
        obstacle.overlap_capsule(capsule, &mut contacts)
    });
    contacts
}

/// A random point in a cube around the origin.
fn point(rng: &mut fastrand::Rng, size: f64) -> DVec3 {
    let mut side = || (rng.f64() * 2.0 - 1.0) * size;
    DVec3::new(side(), side(), side())
}

fn triangle(corners: [DVec3; 3]) -> Shape {
    Shape {
        positions: corners.to_vec(),
        triangles: vec![[0, 1, 2]],
    }
}

/// A point rounded to f32, as in the mesh and the query.
fn rounded(p: DVec3) -> DVec3 {
    p.as_vec3().as_dvec3()
}

pub(crate) fn a_sliver_is_hit_exactly_where_it_is() {
    let mut rng = fastrand::Rng::with_seed(15);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..300 {
        let (a, along) = (point(&mut rng, 3.0), point(&mut rng, 1.0).normalize() * 5.0);
        let aside = along.any_orthonormal_vector() * 0.0004;
        let corners = [a, a + along, a + along * rng.f64() + aside].map(rounded);
        // The ball passes a point near the sliver.
        let aim = a + along * rng.f64() + point(&mut rng, 0.5);
        let from = rounded(aim + point(&mut rng, 3.0));
        let way = rounded((aim - from) * 2.0);
        let truth = segment_distance([from, from + way], &corners);
        if (truth - 0.2).abs() < 1e-3 {
            continue;
        }
        for &played in kinds() {
            let stage = Stage::new(played).with_still(&triangle(corners));
            let ball = WorldCapsule::ball(from, 0.2);
            let hit = cast(&stage, &ball, way, TargetMotion::Still);
            assert_eq!(
                hit.is_some(),
                truth < 0.2,
                "{played:?}: {truth} from {corners:?}"
            );
            if let Some(hit) = hit {
                let at = from + way * hit.fraction;
                let distance = distance(at, &corners);
                let allowed = if hit.started_inside {
                    0.0..=0.2
                } else {
                    0.2 - 1e-5..=0.2 + 1.1e-4
                };
                assert!(
                    allowed.contains(&distance),
                    "{played:?}: stops at {distance}"
                );
                hits += 1;
            } else {
                misses += 1;
            }
        }
    }
    assert!(hits > 100 && misses > 100, "{hits} hits, {misses} misses");
}

pub(crate) fn a_capsule_parallel_to_a_triangle_has_the_exact_distance() {
    let corners = [(-2.0, -2.0), (-2.0, 3.0), (4.0, 0.5)].map(|(x, z)| DVec3::new(x, 0.0, z));
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&triangle(corners));
        for (a, b) in [
            // Above the interior, across an edge, along an edge, beside the triangle, and in its plane.
            ((0.0, 0.25, 0.0), (1.0, 0.25, 0.5)),
            ((-3.0, 0.25, 0.0), (0.0, 0.25, 0.0)),
            ((-2.0, 0.25, -1.0), (-2.0, 0.25, 1.0)),
            ((-2.2, 0.1, -1.0), (-2.2, 0.1, 1.0)),
            ((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
        ] {
            let ends = [a, b].map(DVec3::from);
            let capsule = WorldCapsule { ends, radius: 0.3 };
            let found = overlaps(&stage, &capsule);
            let truth = segment_distance(ends, &corners);
            assert_eq!(found.len(), 1, "{played:?}: {ends:?}, {truth} away");
            let off = found[0].distance - truth;
            within!(off.abs(), 1e-6, "{played:?}: {ends:?}: off by {off}");
            let away = found[0].separation_normal(capsule.nearest_on_axis(found[0].point));
            assert!((away.length() - 1.0).abs() <= 1e-9, "{away}");
        }
    }
}

pub(crate) fn a_cast_that_starts_inside_hits_at_time_0() {
    let shape = Shape::boxed(DVec3::splat(-1.0), DVec3::splat(1.0));
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&shape);
        // The ball starts outside the face, inside, outside and moves away, and on the face.
        for (height, way) in [(1.2, -5.0), (0.8, -5.0), (1.2, 5.0), (1.0, 1.0)] {
            let ball = WorldCapsule::ball(DVec3::Y * height, 0.5);
            let hit = cast(&stage, &ball, DVec3::Y * way, TargetMotion::Still);
            let hit = hit.unwrap_or_else(|| panic!("{played:?}: nothing at {height}"));
            assert_eq!(hit.fraction, 0.0, "{played:?}");
            assert!(hit.started_inside, "{played:?}");
            let contact = hit.contact;
            assert!((contact.normal - DVec3::Y).length() <= 1e-6, "{contact:?}");
        }
    }
}

pub(crate) fn a_core_on_a_feature_has_a_unit_separation_normal() {
    let corners = [(-2.0, -2.0), (-2.0, 3.0), (4.0, 0.5)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let [a, b, _] = corners;
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&triangle(corners));
        for center in [DVec3::ZERO, (a + b) * 0.5, a] {
            let along = |from: DVec3, to: DVec3| WorldCapsule {
                ends: [from, to],
                radius: 0.5,
            };
            for capsule in [
                WorldCapsule::ball(center, 0.5),
                // These capsules pass through the feature, lie along it, or have an end on it.
                along(center - DVec3::Y, center + DVec3::Y),
                along(center - DVec3::Z, center + DVec3::Z),
                along(center, center + DVec3::Y),
            ] {
                let found = overlaps(&stage, &capsule);
                assert_eq!(found.len(), 1, "{played:?}: {capsule:?}");
                let first = found[0];
                assert!(first.distance.abs() <= 1e-5, "{played:?}: {first:?}");
                let away = found[0].separation_normal(capsule.nearest_on_axis(found[0].point));
                assert!((away.length() - 1.0).abs() <= 1e-5, "{played:?}: {away}");
                let hit = cast(&stage, &capsule, DVec3::X, TargetMotion::Still);
                let away = hit.map(|hit| hit.separation_normal);
                let is_unit = away.is_some_and(|away| (away.length() - 1.0).abs() <= 1e-5);
                assert!(is_unit, "{played:?}: {away:?} of {capsule:?}");
            }
        }
    }
}

pub(crate) fn capsules_near_seams_and_edges_have_the_distance_of_brute_force() {
    let mut rng = fastrand::Rng::with_seed(37);
    let mut near = 0;
    for _ in 0..400 {
        let [a, b, c, d] = [(); 4].map(|()| rounded(point(&mut rng, 2.0)));
        let two = Shape {
            positions: vec![a, b, c, d],
            triangles: vec![[0, 1, 2], [0, 3, 1]],
        };
        // Half of the capsules are around the common edge.
        let middle = if rng.bool() {
            a.lerp(b, rng.f64())
        } else {
            DVec3::ZERO
        };
        let ends = [(); 2].map(|()| rounded(middle + point(&mut rng, 1.0)));
        let radius = 0.25;
        let truth = Triangles(vec![[a, b, c], [a, d, b]]).segment_distance(ends);
        if (truth - radius).abs() < 1e-5 {
            continue;
        }
        for &played in kinds() {
            let stage = Stage::new(played).with_still(&two);
            let found = overlaps(&stage, &WorldCapsule { ends, radius });
            let distances = found.iter().map(|contact| contact.distance);
            let nearest = distances.fold(f64::INFINITY, f64::min);
            assert_eq!(found.is_empty(), truth > radius, "{played:?}: {truth}");
            if truth <= radius {
                near += 1;
                assert!(
                    (nearest - truth).abs() <= 2e-6,
                    "{played:?}: {nearest}, not {truth}"
                );
            }
        }
    }
    assert!(near > 100, "{near}");
}

pub(crate) fn tiny_motions_hit_nothing_and_end() {
    let shape = Shape::boxed(DVec3::splat(-1.0), DVec3::splat(1.0));
    for &played in kinds() {
        let stage = Stage::new(played).with_still(&shape);
        let directions = [DVec3::X, -DVec3::Y, DVec3::new(1.0, -1.0, 1.0)];
        for (size, direction) in pairs([6.9e-39, 5e-324, 1e-45, 1e-20], directions) {
            let ball = WorldCapsule::ball(DVec3::Y * 2.0, 0.5);
            let hits = TARGETS.map(|target| cast(&stage, &ball, direction * size, target));
            assert_eq!(hits, [None; 2], "{played:?}: {size}");
        }
    }
}

pub(crate) fn obstacles_that_do_not_approach_are_not_hit() {
    let shape = Shape::boxed(DVec3::splat(-1.0), DVec3::splat(1.0));
    for &played in kinds() {
        // The box moves with the ball, or more slowly: it does not approach.
        let mut stage = Stage::new(played).with(&shape, |time| shifted(DVec3::Y * (60.0 * time)));
        stage.advance();
        let ball = WorldCapsule::ball(DVec3::Y * 1.6, 0.5);
        for way in [1.0, 1.5, 30.0] {
            let hit = cast(&stage, &ball, DVec3::Y * way, TargetMotion::Moving);
            assert_eq!(hit, None, "{played:?}: {way}");
        }
        let hit = cast(&stage, &ball, DVec3::ZERO, TargetMotion::Moving);
        let hit = hit.unwrap_or_else(|| panic!("{played:?}: nothing where the box comes"));
        assert!(
            (hit.fraction - 0.1).abs() <= 1e-3,
            "{played:?}: {}",
            hit.fraction
        );
        // Ball and box are both at rest.
        stage.hold();
        let ball = WorldCapsule::ball(DVec3::Y * 3.0, 0.5);
        for way in [DVec3::ZERO, DVec3::Y, DVec3::X] {
            let hits = TARGETS.map(|target| cast(&stage, &ball, way, target));
            assert_eq!(hits, [None; 2], "{played:?}: {way}");
        }
    }
}

pub(crate) fn a_solid_around_the_core_reports_the_way_out() {
    let stage = Stage::new(Played::Body)
        .with_bodies(|bodies| bodies.add_fixed(ColliderBuilder::cuboid(1.0, 1.0, 1.0)));
    for (center, out, distance) in [
        (DVec3::new(0.8, 0.3, 0.0), DVec3::X, -0.2),
        (DVec3::new(0.0, -0.9, 0.2), -DVec3::Y, -0.1),
    ] {
        let found = overlaps(&stage, &WorldCapsule::ball(center, 0.5));
        assert_eq!(found.len(), 1);
        let first = found[0];
        assert!((first.distance - distance).abs() <= 1e-5, "{first:?}");
        assert!(
            (found[0].separation_normal(center) - out).length() <= 1e-5,
            "{:?}",
            found[0]
        );
    }
}
