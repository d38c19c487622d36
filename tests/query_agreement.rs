//! Every query against brute force over all triangles, on real models in motion: equal in every
//! bit, at seeded places near the skin.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber::prelude::*;
use clamber_scenes::{Creature, beast::beast, test_data};
use glam::{DQuat, DVec3, Vec3};

/// Poses of each clip, and places in each pose.
const POSES: u32 = 4;
const PLACES: usize = 12;

/// Compares all queries over the poses of all clips; gives how many hits there were.
fn assert_agreement(creature: &Creature) -> usize {
    let mut rng = fastrand::Rng::with_seed(0x5eed);
    let mut surface = SkinnedSurface::new(creature.collider.clone());
    let rest = creature.skeleton.rest_pose();
    let (mut hits, mut expected) = (Vec::new(), Vec::new());
    let mut found = 0;
    for clip in &creature.clips {
        for k in 0..POSES {
            let time = clip.duration() * f64::from(k) / f64::from(POSES);
            let pose = clip.sample(&rest, time, Playback::Loop).unwrap();
            let palette = creature.skeleton.palette(&pose).unwrap();
            let world_from_model = Similarity {
                rotation: DQuat::IDENTITY,
                scale: 3.0,
                translation: DVec3::new(f64::from(k), 0.0, 0.0),
            };
            surface.advance(&palette, world_from_model).unwrap();
            let positions = surface.positions();
            let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
            let high = positions
                .iter()
                .copied()
                .fold(Vec3::NEG_INFINITY, Vec3::max);
            let size = (high - low).length();
            for _ in 0..PLACES {
                let near = positions[rng.usize(0..positions.len())];
                let mut offset = || (rng.f32() - 0.5) * size * 0.2;
                let place = near + Vec3::new(offset(), offset(), offset());
                let target = positions[rng.usize(0..positions.len())];
                let context = format!("{}, {}, {time} s, {place}", creature.name, clip.name);
                if let Some(ray) = Ray::new(place, target - place) {
                    let hit = surface.cast_ray(&ray, size).unwrap();
                    assert_eq!(
                        hit,
                        surface.cast_ray_reference(&ray, size).unwrap(),
                        "{context}"
                    );
                    found += usize::from(hit.is_some());
                }
                let reach = size * rng.f32() * 0.2;
                let closest = surface.closest_point(place, reach).unwrap();
                let reference = surface.closest_point_reference(place, reach).unwrap();
                assert_eq!(closest, reference, "{context}");
                let sphere = Sphere {
                    center: place,
                    radius: reach,
                };
                surface.overlap_sphere(&sphere, &mut hits).unwrap();
                surface
                    .overlap_sphere_reference(&sphere, &mut expected)
                    .unwrap();
                assert_eq!(hits, expected, "{context}");
                found += usize::from(closest.is_some()) + hits.len();
            }
        }
    }
    found
}

#[test]
fn beast_answers_like_brute_force() {
    let found = assert_agreement(&beast(3_000));
    assert!(found > 1_000, "only {found} hits");
}

#[test]
fn five_models_answer_like_brute_force() {
    for creature in test_data::five_creatures("query agreement").unwrap() {
        let found = assert_agreement(&creature);
        println!("{}: {found} hits, all equal to brute force", creature.name);
        assert!(found > 100, "{}: only {found} hits", creature.name);
    }
}
