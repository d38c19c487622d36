//! Proxies far away, in moving frames, beside an origin that moves, and in worlds that were saved.

use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::Transform;

use super::{Engine, Falls, Scene, settings};

/// Moves the origin of Bevy's space, with everything in it.
fn move_origin(scene: &mut Scene, shift: Vec3) {
    let world = scene.app.world_mut();
    world.resource_mut::<WorldOrigin>().0 += shift.as_dvec3();
    let mut all = world.query_filtered::<&mut Transform, Without<ChildOf>>();
    for mut transform in all.iter_mut(world) {
        transform.translation -= shift;
    }
}

fn falls(scene: &Scene) -> &[Option<Entity>] {
    &scene.app.world().resource::<Falls>().0
}

#[test]
fn crates_rest_on_climbers_and_knock_them_down_wherever_the_origin_is() {
    for (engine, hz) in settings() {
        for (moves, mass) in [(false, 10.0), (false, 200.0), (true, 10.0), (true, 200.0)] {
            let told = format!("{engine:?}, {hz} Hz, moves: {moves}, {mass} kg");
            let mut scene = Scene::new(engine, hz, true);
            let far = DVec3::new(3e6, 2e5, -1e6);
            scene.app.insert_resource(WorldOrigin(far));
            let load = scene.add_above(if mass > 100.0 { 2.5 } else { 1.5 }, mass);
            for _ in 0..16 {
                scene.run(0.15);
                if moves {
                    move_origin(&mut scene, Vec3::new(7.0, 0.5, -11.0));
                }
            }
            if mass > 100.0 {
                assert_eq!(falls(&scene).first(), Some(&Some(load)), "{told}");
            } else {
                let above = scene.above(load);
                assert!((above - 0.71).abs() < 0.02, "{told}: {above}");
                assert_eq!(scene.state().mode, ClimberMode::Standing, "{told}");
                assert!(falls(&scene).is_empty(), "{told}");
            }
        }
    }
}

#[test]
fn crates_rest_on_climbers_and_knock_them_down_on_a_fast_deck() {
    let speed = Vec3::new(30.0, 0.0, 4.0);
    for (engine, hz) in settings() {
        for (height, mass, knocks) in [(1.5, 10.0, false), (2.5, 200.0, true)] {
            let told = format!("{engine:?}, {hz} Hz, {mass} kg");
            let mut scene = Scene::new(engine, hz, true);
            scene.add_deck(10.0, speed);
            // The climber comes to rest on the deck first.
            scene.run(0.5);
            let place = scene.state().position.as_vec3() + Vec3::Y * height;
            let load = scene.add(Vec3::splat(0.6), place, Some(mass));
            scene.send(load, speed);
            scene.run(1.5);
            let above = scene.above(load);
            if knocks {
                assert_eq!(falls(&scene).first(), Some(&Some(load)), "{told}");
            } else {
                assert!((above - 0.71).abs() < 0.02, "{told}: {above}");
                assert!(falls(&scene).is_empty(), "{told}");
            }
        }
    }
}

/// How many bodies stand for climbers in avian's world.
fn stand_ins(scene: &mut Scene) -> usize {
    use avian3d::prelude::RigidBody;
    let world = scene.app.world_mut();
    let mut bodies = world.query::<&RigidBody>();
    bodies
        .iter(world)
        .filter(|body| body.is_kinematic())
        .count()
}

#[test]
fn the_body_of_a_climber_goes_with_it_and_one_of_a_saved_world_goes_at_once() {
    let mut scene = Scene::new(Engine::Avian, 64.0, true);
    scene.run(0.1);
    assert_eq!(stand_ins(&mut scene), 1);
    // What a scene that was saved with everything in it would spawn.
    let registry = scene.app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let stand_in = registry.get_with_short_type_path("StandIn").unwrap();
    let component = stand_in.data::<ReflectComponent>().unwrap();
    let world = scene.app.world_mut();
    let mut old = world.spawn((
        avian3d::prelude::RigidBody::Kinematic,
        avian3d::prelude::Collider::sphere(0.4),
        Transform::from_xyz(0.0, 0.9, 0.0),
    ));
    component.insert(
        &mut old,
        &bevy_reflect::structs::DynamicStruct::default(),
        &registry,
    );
    assert_eq!(stand_ins(&mut scene), 2);
    scene.run(0.1);
    assert_eq!(stand_ins(&mut scene), 1);
    assert_eq!(scene.state().mode, ClimberMode::Standing);
    let climber = scene.climber;
    scene
        .app
        .world_mut()
        .entity_mut(climber)
        .remove::<AvianProxy>();
    scene.run(0.1);
    assert_eq!(stand_ins(&mut scene), 0);
}
