//! Bodies of `bevy_rapier3d` that fall on climbers.

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::AssetPlugin;
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::events::ClimberTumbled;
use bevy_clamber::prelude::*;
use bevy_clamber::{RapierProxy, RapierProxyPlugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::MeshPlugin;
use bevy_rapier3d::prelude::{
    Collider, ColliderMassProperties, LockedAxes, NoUserData, RapierPhysicsPlugin, RigidBody,
    TimestepMode,
};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;

#[derive(Resource, Default)]
struct Falls(Vec<Option<Entity>>);

/// A climber that stands on level ground, and a crate above it.
fn scene(hz: f64, mass: f32, height: f32, seen: bool) -> (App, Entity, Entity) {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
    ))
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
    .insert_resource(Time::<Fixed>::from_hz(hz))
    .insert_resource(TimestepMode::Fixed {
        dt: (1.0 / hz) as f32,
        substeps: 1,
    })
    .add_plugins((
        RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule(),
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        RapierProxyPlugin::default(),
    ));
    app.init_resource::<Falls>();
    let note = |fell: On<ClimberTumbled>, mut all: ResMut<Falls>| all.0.push(fell.by);
    app.add_observer(note);
    app.finish();
    app.cleanup();
    let world = app.world_mut();
    world.spawn((
        Transform::from_xyz(0.0, -0.5, 0.0),
        RigidBody::Fixed,
        Collider::cuboid(50.0, 0.5, 50.0),
    ));
    let climber = (
        Climber::colossus_climber(),
        Transform::from_xyz(0.0, 0.41, 0.0),
    );
    let climber = world.spawn(climber).id();
    if seen {
        world.entity_mut(climber).insert(RapierProxy);
    }
    let load = world.spawn((
        Transform::from_translation(Vec3::Y * (0.4 + height)),
        RigidBody::Dynamic,
        LockedAxes::ROTATION_LOCKED,
        Collider::cuboid(0.3, 0.3, 0.3),
        ColliderMassProperties::Mass(mass),
    ));
    let load = load.id();
    (app, climber, load)
}

fn above(app: &App, climber: Entity, load: Entity) -> f32 {
    let at = |entity| app.world().get::<Transform>(entity).unwrap().translation.y;
    at(load) - at(climber)
}

#[test]
fn a_light_crate_rests_on_a_climber_that_rapier_knows() {
    for hz in [30.0, 64.0, 240.0] {
        let (mut app, climber, load) = scene(hz, 10.0, 1.5, true);
        for _ in 0..(2.5 * hz) as u32 {
            app.update();
        }
        let mode = app.world().get::<ClimberState>(climber).unwrap().mode;
        assert_eq!(mode, ClimberMode::Standing, "{hz} Hz");
        let above = above(&app, climber, load);
        assert!((above - 0.71).abs() < 0.015, "{hz} Hz: {above}");
        assert!(app.world().resource::<Falls>().0.is_empty());
        // Without its proxy, the crate falls.
        app.world_mut().despawn(climber);
        for _ in 0..hz as u32 {
            app.update();
        }
        let height = app.world().get::<Transform>(load).unwrap().translation.y;
        assert!((height - 0.3).abs() < 0.02, "{hz} Hz: {height}");
    }
}

#[test]
fn a_heavy_crate_knocks_the_climber_down_and_is_named() {
    for hz in [30.0, 64.0, 240.0] {
        let (mut app, _, load) = scene(hz, 200.0, 2.5, true);
        for _ in 0..(1.5 * hz) as u32 {
            app.update();
        }
        let falls = &app.world().resource::<Falls>().0;
        assert_eq!(falls.first(), Some(&Some(load)), "{hz} Hz");
    }
}

#[test]
fn without_the_component_the_crate_falls_through() {
    let (mut app, climber, load) = scene(64.0, 10.0, 1.5, false);
    for _ in 0..160 {
        app.update();
    }
    let above = above(&app, climber, load);
    assert!(above < 0.65, "{above}");
}
