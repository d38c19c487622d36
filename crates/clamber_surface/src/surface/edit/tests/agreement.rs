//! Thousands of edits in motion: the results equal brute force, and a mesh clustered from scratch.

use std::sync::Arc;

use super::model::{KINDS, Model};
use super::sound::{assert_poses_hold, assert_sound};
use crate::bounds::tests::random::{Spread, creature};
use crate::geometry::{Similarity, rotation_from_axis_angle};
use crate::mesh::ColliderMesh;
use crate::surface::SkinnedSurface;
use crate::surface::agreement::{assert_queries_agree, assert_same_answers, questions};
use crate::testing::{bend, cases, tube};
use glam::DVec3;

/// The same surface, with clusters and hierarchy made from scratch.
fn rebuilt(surface: &SkinnedSurface) -> SkinnedSurface {
    let mut fresh = surface.clone();
    let instance = &mut fresh.instance;
    Arc::make_mut(&mut instance.mesh).cluster();
    instance.current = surface.instance.current.renewed(&instance.mesh);
    instance.previous = surface.instance.previous.renewed(&instance.mesh);
    fresh
}

/// Edits a creature in motion until `edits` edits were made; returns how many of each kind.
fn edit_at_random(mesh: Arc<ColliderMesh>, seed: u64, edits: usize) -> [usize; KINDS] {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (joints, parts) = (mesh.joint_count() as u32, mesh.parts().len());
    let mut surface = SkinnedSurface::new(mesh);
    let mut model = Model::of(&surface);
    let mut found = 0;
    for round in 0.. {
        let made: usize = model.made.iter().sum();
        if made >= edits {
            break;
        }
        let case = format!("seed {seed}, round {round}");
        match rng.u32(0..8) {
            0 | 1 => {
                let axis = DVec3::new(0.0, 0.6, 0.8);
                let bent = bend(joints, axis, f64::from(rng.f32()) * 2.0 - 1.0);
                let mut world = *surface.world_from_model();
                if rng.bool() {
                    world = Similarity {
                        rotation: rotation_from_axis_angle(axis, f64::from(rng.f32())),
                        scale: 1.0,
                        translation: DVec3::splat(f64::from(rng.f32())),
                    };
                }
                surface.advance(&bent, world).unwrap();
            }
            2 => surface.skin_ahead(),
            _ => {}
        }
        for _ in 0..rng.usize(0..4) {
            model.flag(&mut surface, &mut rng);
        }
        let size = [1, 2, 8][rng.usize(0..3)];
        surface.edit(|edit| {
            for _ in 0..size {
                model.change(edit, &mut rng);
            }
        });
        model.check(&surface, &case);
        assert_sound(surface.mesh(), &case);
        found += assert_queries_agree(&surface, &mut rng, 1);
        let fresh = rebuilt(&surface);
        let questions = questions(&surface, &mut rng, 1);
        found += assert_same_answers(&surface, &fresh.in_model(), &questions);
        if round % 8 == 0 {
            assert_poses_hold(&surface, &case);
        }
    }
    assert!(found > edits, "seed {seed}: {found}");
    assert_eq!(
        surface.mesh().parts().len() > parts,
        parts < joints as usize
    );
    model.made
}

fn all_kinds(made: &[usize; KINDS], edits: usize) {
    assert!(made.iter().sum::<usize>() >= edits, "{made:?}");
    assert!(made.iter().all(|count| *count * 60 > edits), "{made:?}");
}

#[test]
fn edits_of_a_small_tube_agree_with_a_rebuild() {
    let edits = cases(6_000);
    all_kinds(&edit_at_random(tube(4, 6), 91, edits), edits);
}

#[test]
fn edits_of_parts_of_many_clusters_agree_with_a_rebuild() {
    let edits = cases(1_000);
    all_kinds(&edit_at_random(tube(3, 100), 93, edits), edits);
}

#[test]
fn edits_of_few_parts_for_many_joints_agree_with_a_rebuild() {
    let mut rng = fastrand::Rng::with_seed(94);
    let (mesh, _) = creature(&mut rng, 3, Spread::Few);
    assert!(mesh.parts().len() < 15);
    all_kinds(&edit_at_random(Arc::new(mesh), 94, 1_000), 1_000);
}
