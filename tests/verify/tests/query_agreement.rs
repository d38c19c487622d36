//! Every query on real models in motion gives the same bits as brute force over all triangles, at seeded random places
//! near the skin.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_scenes::giant::giant_of;
use clamber_scenes::{Creature, test_data};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Playback;
use clamber_surface::surface::SkinnedSurface;
use clamber_verify::agreement::Agreement;
use clamber_verify::posed::compare_queries;
use glam::{DQuat, DVec3};

/// Number of poses of each clip in which the queries are compared.
const POSES: u32 = 4;

/// Compares all queries over the poses of all clips; returns the number of hits.
fn assert_agreement(creature: &Creature) -> usize {
    let mut rng = fastrand::Rng::with_seed(0x5eed);
    let mut surface = SkinnedSurface::new(creature.rig.collider.clone());
    let rest = creature.rig.skeleton.rest_pose();
    let mut hits = 0;
    for clip in &creature.rig.clips {
        for k in 0..POSES {
            let time = clip.duration() * f64::from(k) / f64::from(POSES);
            let pose = clip.sample(&rest, time, Playback::Loop).unwrap();
            let palette = creature.rig.skeleton.palette(&pose).unwrap();
            let world_from_model = Similarity {
                rotation: DQuat::IDENTITY,
                scale: 3.0,
                translation: DVec3::new(f64::from(k), 0.0, 0.0),
            };
            surface.advance(&palette, world_from_model).unwrap();
            let mut agreement = Agreement::default();
            compare_queries(&surface, &mut rng, &mut agreement);
            let context = format!("{}, {}, {time} s", creature.name, clip.name);
            assert_eq!(agreement.first, None, "{context}");
            hits += agreement.found;
        }
    }
    hits
}

#[test]
fn the_giant_answers_like_brute_force() {
    let mut giant = giant_of(3_000).unwrap();
    giant
        .rig
        .clips
        .retain(|clip| ["idle", "walk", "shake"].contains(&clip.name.as_str()));
    let found = assert_agreement(&giant);
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
