//! A world is written as Bevy writes worlds, read into another app, and goes on there.

use bevy_app::App;
use bevy_asset::AssetServer;
use bevy_clamber::clamber_climber::{ClimberState as State, Support};
use bevy_clamber::clamber_world::{Attachment, ObstacleId};
use bevy_clamber::prelude::*;
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::reflect::AppTypeRegistry;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;
use bevy_world_serialization::serde::WorldDeserializer;
use bevy_world_serialization::{DynamicWorld, DynamicWorldBuilder};
use serde::de::DeserializeSeed;

use super::common::{self, LYING, Limb, app_with, limb};

/// A floor of skin in an app with climbers.
fn scene() -> (App, Limb) {
    let plugins = (
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberCameraPlugin,
    );
    let mut app = app_with(64.0, plugins);
    app.register_type::<Transform>();
    let lying = Transform::from_rotation(LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::each_tick());
    (app, floor)
}

fn read(app: &App, text: &str) -> DynamicWorld {
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let mut server = app.world().resource::<AssetServer>();
    let reader = WorldDeserializer {
        type_registry: &registry,
        load_from_path: &mut server,
    };
    let mut text = ron::de::Deserializer::from_str(text).unwrap();
    reader.deserialize(&mut text).unwrap()
}

/// Its obstacle is another entity in another world.
fn without_support(state: State) -> State {
    let known = state.support.map(|support| Support {
        attachment: Attachment {
            obstacle: ObstacleId(0),
            ..support.attachment
        },
        ..support
    });
    State {
        support: known,
        ..state
    }
}

#[test]
fn climbers_and_cameras_are_saved_and_loaded_to_the_bit() {
    let (mut app, floor) = scene();
    let mut config = Climber::colossus_climber().config;
    config.ground.walk_speed = 4.5;
    let ghost = app.world_mut().spawn_empty().id();
    let climber = (
        Climber::new(config),
        ClimberFilter {
            layers: 5,
            ignored: [ghost].into_iter().collect(),
        },
        Transform::from_xyz(3.1, 2.6, 0.4).with_rotation(Quat::from_xyzw(0.0, 0.6, 0.0, 0.8)),
    );
    let climber = app.world_mut().spawn(climber).id();
    let camera = app
        .world_mut()
        .spawn(ClimberCamera::like_2005(climber))
        .id();
    app.world_mut()
        .get_mut::<ClimberInput>(climber)
        .unwrap()
        .walk = Vec3::new(0.3, 0.0, 0.1);
    for _ in 0..100 {
        app.update();
    }
    let blow = ClimberBlow {
        velocity: Vec3::X * 0.1,
        damage: 0.0,
        by: Some(ghost),
    };
    let mut input = app.world_mut().get_mut::<ClimberInput>(climber).unwrap();
    input.strike(blow);
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let saved = DynamicWorldBuilder::from_world(app.world(), &registry.read())
        .allow_component::<Climber>()
        .allow_component::<ClimberState>()
        .allow_component::<ClimberInput>()
        .allow_component::<ClimberFilter>()
        .allow_component::<ClimberCamera>()
        .allow_component::<Transform>()
        .extract_entities([climber, camera].into_iter())
        .build();
    let text = saved.serialize(&registry.read()).unwrap();

    // The floor is another entity there, and is no part of what was saved.
    let (mut other, _) = scene();
    let lying = Transform::from_rotation(LYING).with_scale(Vec3::splat(10.0));
    let there = limb(&mut other, lying, SkinnedCollider::each_tick());
    let away = lying.with_translation(Vec3::NEG_Y * 50.0);
    *other.world_mut().get_mut::<Transform>(floor.root).unwrap() = away;
    assert_ne!(there.mesh, floor.mesh);
    let loaded = read(&other, &text);
    let mut ids = EntityHashMap::default();
    ids.insert(floor.mesh, there.mesh);
    // Entities that the loaded ones refer to are others here.
    other.world_mut().spawn_batch([(), ()]).for_each(drop);
    let ghost_there = other.world_mut().spawn_empty().id();
    ids.insert(ghost, ghost_there);
    assert_ne!(ghost, ghost_there);
    loaded.write_to_world(other.world_mut(), &mut ids).unwrap();
    let (new_climber, new_camera) = (ids[&climber], ids[&camera]);
    let same = |app: &App, other: &App| {
        let [from, to] = [(app, climber), (other, new_climber)].map(|(app, climber)| {
            let world = app.world();
            (
                *world.get::<Climber>(climber).unwrap(),
                without_support(world.get::<ClimberState>(climber).unwrap().0),
                world.get::<ClimberInput>(climber).unwrap().walk,
                world.get::<ClimberFilter>(climber).unwrap().layers,
                *world.get::<Transform>(climber).unwrap(),
            )
        });
        assert_eq!(from, to);
    };
    same(&app, &other);
    let filter = other.world().get::<ClimberFilter>(new_climber).unwrap();
    assert_eq!(filter.ignored, [ghost_there].into_iter().collect());
    let input = other.world().get::<ClimberInput>(new_climber).unwrap();
    let expected = ClimberBlow {
        by: Some(ghost_there),
        ..blow
    };
    assert_eq!(input.blow, Some(expected));
    let on = other
        .world()
        .get::<ClimberState>(new_climber)
        .unwrap()
        .support;
    assert_eq!(on.unwrap().attachment.obstacle.0, there.mesh.to_bits());
    let follows = other.world().get::<ClimberCamera>(new_camera).unwrap();
    assert_eq!(follows.target, new_climber);
    // It goes on from there.
    for _ in 0..30 {
        app.update();
        other.update();
    }
    let position = |app: &App, climber| app.world().get::<ClimberState>(climber).unwrap().position;
    let apart = position(&app, climber).distance(position(&other, new_climber));
    assert!(apart < 1e-9, "{apart}");
}

#[test]
fn colliders_tags_and_anchors_are_saved_and_loaded() {
    let (mut app, floor) = scene();
    let world = app.world_mut();
    world.entity_mut(floor.mesh).insert(ColliderTag(
        SurfaceTag::new(SurfaceKind::Stone).with_user(1),
    ));
    common::wait(&mut app, floor.mesh);
    let surface = app.world().get::<PosedSurface>(floor.mesh).unwrap();
    let triangle = bevy_clamber::clamber_surface::mesh::TriangleId(7);
    let anchor = surface.anchor(triangle, [0.2, 0.3, 0.5]).unwrap();
    let anchor = SurfaceAnchor::new(floor.mesh, surface, anchor, Quat::IDENTITY);
    let arrow = app.world_mut().spawn(anchor).id();
    app.update();
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let saved = DynamicWorldBuilder::from_world(app.world(), &registry.read())
        .allow_component::<SkinnedCollider>()
        .allow_component::<ColliderTag>()
        .allow_component::<SurfaceAnchor>()
        .allow_resource::<WorldOrigin>()
        .extract_entities([floor.mesh, arrow].into_iter())
        .extract_resources()
        .build();
    let text = saved.serialize(&registry.read()).unwrap();
    let mut other = scene().0;
    let mut ids = EntityHashMap::default();
    read(&other, &text)
        .write_to_world(other.world_mut(), &mut ids)
        .unwrap();
    let (mesh, arrow_there) = (ids[&floor.mesh], ids[&arrow]);
    let (from, to) = (app.world(), other.world());
    assert_eq!(
        to.get::<SkinnedCollider>(mesh),
        from.get::<SkinnedCollider>(floor.mesh)
    );
    assert_eq!(
        to.get::<ColliderTag>(mesh),
        from.get::<ColliderTag>(floor.mesh)
    );
    let expected = SurfaceAnchor {
        surface: mesh,
        ..*from.get::<SurfaceAnchor>(arrow).unwrap()
    };
    assert_eq!(to.get::<SurfaceAnchor>(arrow_there), Some(&expected));
}
