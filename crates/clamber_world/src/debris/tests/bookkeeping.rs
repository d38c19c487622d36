use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{self, CREATURE, DT, Scene, at, lifted, slab};
use crate::debris::{Debris, DebrisConfig, DebrisError};
use crate::testing::rest;

/// Half the size of the creature, metres.
const HALF: Vec3 = Vec3::new(4.0, 0.5, 4.0);

/// Rocks on a heaving back over some ticks, with rapier's origin at `origin`.
fn run(origin: DVec3, ticks: u32) -> Scene {
    let mut scene = Scene::new(slab(HALF, 0.6, 3));
    scene.debris = Debris::new(DebrisConfig::default()).with_origin(origin);
    for index in 0..12 {
        let place = Vector::new(index as f32 * 0.3 - 2.0, 1.2 + index as f32 * 0.4, 0.1);
        let shape = if index % 2 == 0 {
            ColliderBuilder::ball(0.3)
        } else {
            ColliderBuilder::cuboid(0.3, 0.2, 0.25)
        };
        scene.drop(shape, place);
    }
    for tick in 0..ticks {
        let (palette, root) = heaving(tick, origin);
        scene.tick(&palette, root);
    }
    scene
}

/// The palette of a heaving back, and its root, which shakes and turns.
fn heaving(tick: u32, origin: DVec3) -> (Palette, Similarity) {
    let t = f64::from(tick) * DT;
    let palette = lifted(3, |joint| 0.2 * libm::sin(3.0 * t + joint as f64));
    let shake = DVec3::new(0.3 * libm::sin(9.0 * t), 0.0, 0.0);
    (palette, at(origin + shake, DVec3::Y, 0.1 * t))
}

/// Bits of all debris.
fn bits(scene: &Scene) -> Vec<u32> {
    scene::bits(scene.debris.bodies().map(|body| &scene.world.bodies[body]))
}

#[test]
fn two_runs_have_the_same_bits() {
    let (a, b) = (run(DVec3::ZERO, 240), run(DVec3::ZERO, 240));
    assert_eq!(bits(&a), bits(&b));
}

#[test]
fn far_from_the_origin_rocks_ride_as_they_do_near_it() {
    let (near, far) = (run(DVec3::ZERO, 25), run(DVec3::new(1e5, -300.0, 4e4), 25));
    let pairs = near.debris.bodies().zip(far.debris.bodies());
    for (a, b) in pairs {
        let places = [&near.world.bodies[a], &far.world.bodies[b]].map(|body| body.translation());
        let off = (places[0] - places[1]).length();
        assert!(off < 0.01, "{places:?}");
    }
}

#[test]
fn rocks_do_not_change_the_creature() {
    let with = run(DVec3::ZERO, 120);
    let mut without = slab(HALF, 0.6, 3);
    for tick in 0..120 {
        let (palette, root) = heaving(tick, DVec3::ZERO);
        without.advance(&palette, root).unwrap();
    }
    let positions = |surface: &SkinnedSurface| {
        let mut all = Vec::new();
        surface.skin_all(&mut all);
        all
    };
    assert_eq!(positions(&with.surface), positions(&without));
    assert_eq!(with.surface.world_from_model(), without.world_from_model());
}

#[test]
fn a_patch_collides_with_its_own_rock_only_and_contacts_name_its_triangles() {
    let mut scene = run(DVec3::ZERO, 90);
    scene.tick(&lifted(3, |_| 0.0), Similarity::IDENTITY);
    let (mut with_skin, mut touching) = (0, 0);
    for pair in scene.world.narrow_phase.contact_pairs() {
        let [a, b] = [pair.collider1, pair.collider2];
        for (skin, rock) in [(a, b), (b, a)] {
            let Some(owner) = scene.debris.owner_of(skin) else {
                continue;
            };
            with_skin += 1;
            let body = scene.world.colliders[rock].parent();
            for manifold in pair.manifolds() {
                if manifold.points.iter().all(|point| point.dist > 0.02) {
                    continue;
                }
                assert_eq!(body, Some(owner));
                let subshapes = [manifold.subshape1, manifold.subshape2];
                let subshape = subshapes[usize::from(skin == b)];
                let (surface, triangle) = scene.debris.triangle_at(skin, subshape).unwrap();
                assert_eq!(surface, CREATURE);
                // The triangle is near the contact, within rapier's prediction and a tick of motion.
                let (mesh, space) = (scene.surface.mesh(), scene.surface.in_model());
                let corners = mesh.triangles()[triangle.index()];
                let corners = corners.map(|v| space.previous_position(v).unwrap());
                let place = scene.in_model(owner).as_vec3();
                let triangle = rapier3d::parry::shape::Triangle::from(corners);
                use rapier3d::parry::query::PointQuery;
                let distance = triangle.distance_to_local_point(place, true);
                assert!(distance < 0.6, "{distance}");
                touching += 1;
            }
        }
    }
    assert!(with_skin > 4 && touching > 4, "{with_skin} {touching}");
}

#[test]
fn patches_come_back_after_their_bodies_were_removed() {
    let mut scene = Scene::new(slab(HALF, 0.6, 1));
    let (rock, _) = scene.drop(ColliderBuilder::ball(0.3), Vector::new(0.0, 0.85, 0.0));
    let asleep = (0..600).any(|_| {
        scene.tick(&rest(), Similarity::IDENTITY);
        scene.world.bodies[rock].is_sleeping()
    });
    assert!(asleep);
    let bodies = scene.world.bodies.iter();
    let patches = bodies.filter(|(_, body)| body.is_kinematic());
    let patches: Vec<_> = patches.map(|(handle, _)| handle).collect();
    assert_eq!(patches.len(), 1);
    scene.world.remove_body(patches[0]);
    let place = scene.in_model(rock);
    for _ in 0..60 {
        scene.tick(&rest(), Similarity::IDENTITY);
    }
    let moved = (scene.in_model(rock) - place).length();
    assert!(moved < 0.005, "{moved}");
}

#[test]
fn patches_are_reused_when_bodies_come_and_go() {
    let mut scene = Scene::new(slab(HALF, 0.6, 1));
    let place = Vector::new(0.0, 0.8, 0.0);
    let (first, _) = scene.drop(ColliderBuilder::ball(0.3), place);
    let report = scene.tick(&rest(), Similarity::IDENTITY);
    assert_eq!(report.near, 1);
    let bodies = scene.world.bodies.len();
    scene.world.remove_body(first);
    scene.tick(&rest(), Similarity::IDENTITY);
    assert_eq!(scene.debris.bodies().len(), 0);
    // The next body takes over the patch of the removed one.
    let (second, _) = scene.drop(ColliderBuilder::ball(0.3), place);
    let report = scene.tick(&rest(), Similarity::IDENTITY);
    assert_eq!((report.near, scene.world.bodies.len()), (1, bodies));
    assert!(scene.debris.remove(second, &mut scene.world.colliders));
    assert!(!scene.debris.remove(second, &mut scene.world.colliders));
    for _ in 0..60 {
        scene.tick(&rest(), Similarity::IDENTITY);
    }
    let fallen = scene.world.bodies[second].translation().y;
    assert!(fallen < -2.0, "no skin holds it any more: {fallen}");
}

#[test]
fn moving_skin_wakes_a_sleeping_rock() {
    let mut scene = Scene::new(slab(HALF, 0.6, 1));
    let shape = ColliderBuilder::cuboid(0.3, 0.3, 0.3);
    let (rock, _) = scene.drop(shape, Vector::new(0.0, 0.8, 0.0));
    for _ in 0..300 {
        scene.tick(&rest(), Similarity::IDENTITY);
    }
    assert!(scene.world.bodies[rock].is_sleeping());
    // The skin is so slow that rapier would let the rock sleep.
    for tick in 0..600 {
        let x = 0.02 * DT * f64::from(tick);
        scene.tick(&rest(), at(DVec3::X * x, DVec3::Y, 0.0));
    }
    let carried = scene.world.bodies[rock].translation().x;
    assert!((carried - 0.2).abs() < 0.02, "{carried}");
}

#[test]
fn bad_input_is_an_error() {
    let mut scene = Scene::new(slab(HALF, 0.6, 1));
    let (bodies, colliders) = (&mut scene.world.bodies, &mut scene.world.colliders);
    let fixed = bodies.insert(RigidBodyBuilder::fixed());
    let bare = bodies.insert(RigidBodyBuilder::dynamic());
    let debris = &mut scene.debris;
    let result = debris.add(fixed, bodies, colliders);
    assert_eq!(result, Err(DebrisError::NotDynamic(fixed)));
    let result = debris.add(RigidBodyHandle::invalid(), bodies, colliders);
    assert!(matches!(result, Err(DebrisError::NotDynamic(_))));
    let result = debris.add(bare, bodies, colliders);
    assert_eq!(result, Err(DebrisError::NotSolid(bare)));
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let result = debris.before_step(&[(CREATURE, &scene.surface)], bodies, colliders, dt);
        assert!(matches!(result, Err(DebrisError::Tick(_))), "{dt}");
        let (broad, narrow) = (&scene.world.broad_phase, &scene.world.narrow_phase);
        let surfaces = [(CREATURE, &scene.surface)];
        let result = debris.after_step(&surfaces, bodies, colliders, broad, narrow, dt);
        assert!(matches!(result, Err(DebrisError::Tick(_))), "{dt}");
    }
    let (rock, _) = scene.drop(ColliderBuilder::ball(0.3), Vector::new(0.0, 0.8, 0.0));
    let (bodies, colliders) = (&mut scene.world.bodies, &mut scene.world.colliders);
    bodies[rock].set_translation(Vector::splat(f32::INFINITY), false);
    let result = scene
        .debris
        .before_step(&[(CREATURE, &scene.surface)], bodies, colliders, DT);
    assert!(
        matches!(&result, Err(DebrisError::OutOfReach { body, obstacle: CREATURE, .. }) if *body == rock),
        "{result:?}"
    );
}
