//! Bodies of `bevy_rapier3d` lie on skin, are carried by it, and are let go.

use bevy_app::{App, FixedPostUpdate, FixedUpdate, TaskPoolPlugin};
use bevy_asset::AssetPlugin;
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::prelude::*;
use bevy_clamber::{DebrisBodies, DebrisHooks, RapierObstaclesPlugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::MeshPlugin;
use bevy_rapier3d::prelude::{Collider, NoUserData, RapierPhysicsPlugin, RigidBody};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;

use super::common::{self, LYING, Limb, limb};

#[derive(Component)]
struct Moving(Vec3);

fn carry(time: Res<Time<Fixed>>, mut roots: Query<(&mut Transform, &Moving)>) {
    for (mut root, moving) in &mut roots {
        root.translation += moving.0 * time.delta_secs();
    }
}

/// A floor of skin, 20 m long along X and 4 m wide, whose top is at a height of 2 m.
fn scene() -> (App, Limb) {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
        RapierPhysicsPlugin::<DebrisHooks>::default().in_schedule(FixedPostUpdate),
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        DebrisPlugin::default(),
        RapierObstaclesPlugin::in_schedule(FixedPostUpdate),
    ))
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
    .add_systems(FixedUpdate, carry);
    app.finish();
    app.cleanup();
    let lying = Transform::from_rotation(LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::each_tick());
    app.world_mut()
        .entity_mut(floor.joints[1])
        .remove::<common::Bending>();
    (app, floor)
}

fn rock(app: &mut App, at: Vec3) -> Entity {
    let rock = (
        RigidBody::Dynamic,
        Collider::cuboid(0.5, 0.5, 0.5),
        Debris,
        Transform::from_translation(at),
    );
    app.world_mut().spawn(rock).id()
}

fn place(app: &App, entity: Entity) -> Vec3 {
    app.world().get::<Transform>(entity).unwrap().translation
}

fn ticks(app: &mut App, count: usize) {
    for _ in 0..count {
        app.update();
    }
}

#[test]
fn rocks_lie_on_skin_and_are_carried_by_it() {
    let (mut app, floor) = scene();
    let stone = rock(&mut app, Vec3::new(6.0, 4.0, 0.0));
    let bare = rock(&mut app, Vec3::new(12.0, 4.0, 0.0));
    app.world_mut().entity_mut(bare).remove::<Debris>();
    ticks(&mut app, 128);
    let lying = place(&app, stone);
    assert!((lying.y - 2.5).abs() < 0.03, "{lying}");
    assert!(place(&app, bare).y < 0.0, "a body that is no debris");
    assert_eq!(app.world().resource::<DebrisBodies>().report().near, 1);
    // Up and along at 1 m/s, after a soft start.
    app.world_mut()
        .entity_mut(floor.root)
        .insert(Moving(Vec3::ZERO));
    for step in 1..=64 {
        let speed = step as f32 / 64.0;
        app.world_mut().get_mut::<Moving>(floor.root).unwrap().0 = Vec3::new(speed, speed, 0.0);
        app.update();
    }
    let before = place(&app, stone);
    ticks(&mut app, 64);
    let moved = place(&app, stone) - before;
    assert!(moved.distance(Vec3::new(1.0, 1.0, 0.0)) < 0.1, "{moved}");
    // What it lay on is gone.
    app.world_mut().entity_mut(floor.mesh).despawn();
    let before = place(&app, stone);
    ticks(&mut app, 64);
    assert!(place(&app, stone).y < before.y - 2.0);
}

#[test]
fn a_climber_stands_on_skin_beside_a_rock_as_without_it() {
    let mut ends = Vec::new();
    for with_rock in [false, true] {
        let (mut app, floor) = scene();
        if with_rock {
            // So near that its piece of skin in rapier's world is below the climber.
            rock(&mut app, Vec3::new(9.0, 2.6, 0.0));
        }
        let at = Transform::from_xyz(9.95, 3.0, 0.0);
        let climber = app.world_mut().spawn((Climber::walker(), at)).id();
        ticks(&mut app, 128);
        let state = *app.world().get::<ClimberState>(climber).unwrap();
        assert_eq!(state.mode, ClimberMode::Standing);
        let on = state.support.unwrap().attachment.obstacle.0;
        assert_eq!(on, floor.mesh.to_bits(), "it stands on the skin itself");
        let body = app.world().get::<ClimberBody>(climber).unwrap();
        for contact in body.contacts() {
            assert_eq!(contact.obstacle.0, floor.mesh.to_bits(), "{contact:?}");
        }
        ends.push(state);
    }
    assert_eq!(ends[0].position, ends[1].position);
}

#[test]
fn bodies_come_and_go_at_any_time() {
    let (mut app, _) = scene();
    let mut random = fastrand::Rng::with_seed(3);
    let mut rocks: Vec<Entity> = Vec::new();
    for _ in 0..300 {
        match random.u8(0..4) {
            0 | 1 => {
                let (x, z) = (2.0 + 14.0 * random.f32(), 2.0 * random.f32() - 1.0);
                rocks.push(rock(&mut app, Vec3::new(x, 3.5 + random.f32(), z)));
            }
            2 if !rocks.is_empty() => {
                let gone = rocks.swap_remove(random.usize(0..rocks.len()));
                app.world_mut().despawn(gone);
            }
            _ if !rocks.is_empty() => {
                let one = rocks[random.usize(0..rocks.len())];
                let mut one = app.world_mut().entity_mut(one);
                if one.take::<Debris>().is_none() {
                    one.insert(Debris);
                }
            }
            _ => {}
        }
        app.update();
        for rock in &rocks {
            assert!(place(&app, *rock).is_finite());
        }
    }
    assert!(app.world().resource::<DebrisBodies>().report().near > 3);
}

#[test]
#[should_panic(expected = "RapierPhysicsPlugin::<DebrisHooks>")]
fn other_hooks_are_named() {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
        RapierPhysicsPlugin::<NoUserData>::default().in_schedule(FixedPostUpdate),
        ClamberPlugins::default(),
        DebrisPlugin::default(),
    ));
    app.finish();
}
