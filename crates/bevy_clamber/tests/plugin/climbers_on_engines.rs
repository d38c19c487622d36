//! Climbers find the world of avian and of rapier by themselves, are carried by bodies, push them and name them.

use std::collections::BTreeMap;

use avian3d::parry::shape::SharedShape;
use bevy_app::{App, FixedUpdate, TaskPoolPlugin};
use bevy_asset::AssetPlugin;
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::events::ClimberLanded;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, Schedules};
use bevy_math::Vec3;
use bevy_mesh::MeshPlugin;
use bevy_rapier3d::prelude::{NoUserData, PhysicsSet, RapierPhysicsPlugin};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;

/// Metres a second that the platform moves along Z.
const SPEED: f32 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Engine {
    Avian,
    Rapier,
}

#[derive(Component)]
struct Platform;

fn move_platform(time: Res<Time<Fixed>>, mut platforms: Query<&mut Transform, With<Platform>>) {
    for mut transform in &mut platforms {
        transform.translation.z = SPEED * time.elapsed_secs();
    }
}

struct Scene {
    app: App,
    ground: Entity,
    platform: Entity,
    load: Entity,
}

/// Level ground at height 0, a platform of 4 m at height 2 that moves, and a crate of 20 kg.
fn scene(engine: Engine) -> Scene {
    scene_with(engine, true)
}

fn scene_with(engine: Engine, climbers: bool) -> Scene {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
    ))
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
    .insert_resource(Time::<Fixed>::from_hz(64.0));
    if climbers {
        app.add_plugins((ClamberPlugins::default(), ClimberPlugin::default()));
    }
    match engine {
        Engine::Avian => app
            .add_plugins(avian3d::prelude::PhysicsPlugins::default())
            .add_systems(FixedUpdate, move_platform),
        Engine::Rapier => app
            .add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
            .add_systems(FixedUpdate, move_platform.before(PhysicsSet::SyncBackend)),
    };
    if climbers {
        match engine {
            Engine::Avian => app.add_plugins(AvianProxyPlugin::default()),
            Engine::Rapier => app.add_plugins(RapierProxyPlugin::default()),
        };
    }
    app.finish();
    app.cleanup();
    let mut body = |size: [f32; 3], at: Vec3, kind: &str| {
        let shape = SharedShape::cuboid(size[0] / 2.0, size[1] / 2.0, size[2] / 2.0);
        let mut entity = app.world_mut().spawn(Transform::from_translation(at));
        match (engine, kind) {
            (Engine::Avian, kind) => {
                use avian3d::prelude::{Collider, Mass, NoAutoMass, RigidBody};
                let body = match kind {
                    "fixed" => RigidBody::Static,
                    "moved" => RigidBody::Kinematic,
                    _ => RigidBody::Dynamic,
                };
                entity.insert((Collider::from(shape), body));
                if body == RigidBody::Dynamic {
                    entity.insert((Mass(20.0), NoAutoMass));
                }
            }
            (Engine::Rapier, kind) => {
                use bevy_rapier3d::prelude::{Collider, ColliderMassProperties, RigidBody};
                let body = match kind {
                    "fixed" => RigidBody::Fixed,
                    "moved" => RigidBody::KinematicPositionBased,
                    _ => RigidBody::Dynamic,
                };
                entity.insert((Collider::from(shape), body));
                if body == RigidBody::Dynamic {
                    entity.insert(ColliderMassProperties::Mass(20.0));
                }
            }
        }
        entity.id()
    };
    let ground = body([100.0, 1.0, 100.0], Vec3::new(0.0, -0.5, 0.0), "fixed");
    let platform = body([4.0, 1.0, 4.0], Vec3::new(9.0, 1.5, 0.0), "moved");
    let load = body([1.0, 1.0, 1.0], Vec3::new(0.0, 0.5, 4.0), "dynamic");
    app.world_mut().entity_mut(platform).insert(Platform);
    Scene {
        app,
        ground,
        platform,
        load,
    }
}

fn climber(scene: &mut Scene, at: Vec3) -> Entity {
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    scene.app.world_mut().spawn(climber).id()
}

fn run(scene: &mut Scene, ticks: usize) {
    for _ in 0..ticks {
        scene.app.update();
    }
}

fn state(scene: &Scene, climber: Entity) -> ClimberState {
    *scene.app.world().get::<ClimberState>(climber).unwrap()
}

fn at(scene: &Scene, entity: Entity) -> Vec3 {
    let transform = scene.app.world().get::<Transform>(entity).unwrap();
    transform.translation
}

#[derive(Resource, Default)]
struct Landings(Vec<(Entity, Option<Entity>)>);

#[test]
fn a_climber_lands_on_ground_and_platform_and_names_them() {
    for engine in [Engine::Avian, Engine::Rapier] {
        let mut scene = scene(engine);
        scene.app.init_resource::<Landings>();
        let note = |landed: On<ClimberLanded>, mut all: ResMut<Landings>| {
            all.0.push((landed.entity, landed.ground));
        };
        scene.app.add_observer(note);
        run(&mut scene, 3);
        let z = at(&scene, scene.platform).z;
        let on_ground = climber(&mut scene, Vec3::new(-5.0, 1.0, 0.0));
        let on_platform = climber(&mut scene, Vec3::new(9.0, 2.6, z));
        run(&mut scene, 60);
        let landings = &scene.app.world().resource::<Landings>().0;
        assert!(
            landings.contains(&(on_ground, Some(scene.ground))),
            "{engine:?} {landings:?}"
        );
        assert!(
            landings.contains(&(on_platform, Some(scene.platform))),
            "{engine:?} {landings:?}"
        );
        let before = state(&scene, on_platform).position - at(&scene, scene.platform).as_dvec3();
        run(&mut scene, 120);
        let now = state(&scene, on_platform);
        let after = now.position - at(&scene, scene.platform).as_dvec3();
        assert_eq!(now.mode, ClimberMode::Standing, "{engine:?}");
        assert!(
            (after - before).length() < 1e-4,
            "{engine:?}: {before} {after}"
        );
        assert!(
            (now.velocity.z - f64::from(SPEED)).abs() < 1e-3,
            "{engine:?}: {now:?}"
        );
        // What it stands on goes in mid-ride.
        scene.app.world_mut().despawn(scene.platform);
        run(&mut scene, 120);
        let now = state(&scene, on_platform);
        assert!((now.position.y - 0.4).abs() < 0.02, "{engine:?}: {now:?}");
    }
}

#[test]
fn a_climber_pushes_a_crate_as_far_in_both_engines() {
    let moved = [Engine::Avian, Engine::Rapier].map(|engine| {
        let mut scene = scene(engine);
        let pusher = climber(&mut scene, Vec3::new(0.0, 0.5, 2.0));
        run(&mut scene, 40);
        let before = at(&scene, scene.load);
        assert!((before.z - 4.0).abs() < 1e-3, "{engine:?}: {before}");
        let mut input = scene
            .app
            .world_mut()
            .get_mut::<ClimberInput>(pusher)
            .unwrap();
        input.walk = Vec3::Z;
        run(&mut scene, 128);
        let (load, walker) = (at(&scene, scene.load), state(&scene, pusher).position);
        assert!(load.z > 4.5, "{engine:?}: {load}");
        assert!(
            walker.z < f64::from(load.z) - 0.5,
            "{engine:?}: {walker} {load}"
        );
        load.z - before.z
    });
    // The engines' friction differs a little.
    assert!((moved[0] - moved[1]).abs() < 0.5 * moved[0], "{moved:?}");
}

#[test]
fn a_filter_lets_a_climber_through() {
    for engine in [Engine::Avian, Engine::Rapier] {
        let mut scene = scene(engine);
        let through = climber(&mut scene, Vec3::new(-5.0, 1.0, 0.0));
        let filter = ClimberFilter {
            ignored: [scene.ground].into_iter().collect(),
            ..ClimberFilter::default()
        };
        scene.app.world_mut().entity_mut(through).insert(filter);
        let of_no_layer = climber(&mut scene, Vec3::new(-7.0, 1.0, 0.0));
        let filter = ClimberFilter {
            layers: 0,
            ..ClimberFilter::default()
        };
        scene.app.world_mut().entity_mut(of_no_layer).insert(filter);
        let stands = climber(&mut scene, Vec3::new(-9.0, 1.0, 0.0));
        run(&mut scene, 100);
        assert!(state(&scene, through).position.y < -5.0, "{engine:?}");
        assert!(state(&scene, of_no_layer).position.y < -5.0, "{engine:?}");
        assert!(state(&scene, stands).position.y > 0.3, "{engine:?}");
    }
}

/// Number of pairs of systems without an order, per schedule.
fn ambiguities(mut scene: Scene) -> BTreeMap<String, usize> {
    let mut schedules = scene.app.world_mut().resource_mut::<Schedules>();
    for (_, schedule) in schedules.iter_mut() {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Warn,
            ..ScheduleBuildSettings::default()
        });
    }
    run(&mut scene, 5);
    let schedules = scene.app.world().resource::<Schedules>();
    let count = |schedule: &Schedule| schedule.graph().conflicting_systems().0.len();
    schedules
        .iter()
        .map(|(label, schedule)| (format!("{label:?}"), count(schedule)))
        .collect()
}

/// Engines have ambiguities of their own; climbers add none.
#[test]
fn climbers_add_no_ambiguity_to_an_engine() {
    for engine in [Engine::Avian, Engine::Rapier] {
        let without = ambiguities(scene_with(engine, false));
        let mut beside = scene(engine);
        climber(&mut beside, Vec3::new(-5.0, 1.0, 0.0));
        for (label, found) in ambiguities(beside) {
            let known = without.get(&label).copied().unwrap_or_default();
            assert!(
                found <= known,
                "{engine:?} {label}: {found}, without climbers {known}"
            );
        }
    }
}
