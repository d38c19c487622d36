//! An animation that makes poses less often than ticks: blended as the README shows, it shakes nobody.

use bevy_app::{App, FixedPostUpdate, FixedUpdate};
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::clamber_surface::geometry::Similarity;
use bevy_clamber::clamber_surface::rig::{self, Pose, PoseMotion, PoseTrack};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;
use bevy_transform::components::Transform;

use super::common::{self, app_with, limb};

/// Metres a second that the creature moves along X.
const SPEED: f64 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Between {
    Kept,
    Blended,
}

/// On the entity of a `SkinnedCollider`.
#[derive(Component)]
struct SeldomPosed {
    moved: Vec<Entity>,
    poses: PoseTrack,
    /// Ticks between poses.
    every: u32,
    ticks: u32,
    between: Between,
}

fn transform(local: &rig::Transform) -> Transform {
    Transform {
        translation: local.translation,
        rotation: local.rotation,
        scale: local.scale,
    }
}

/// Walks, and bends the upper joint, in every n-th tick.
fn animate(
    time: Res<Time>,
    mut creatures: Query<&mut SeldomPosed>,
    mut transforms: Query<&mut Transform>,
) {
    let now = time.elapsed_secs_f64();
    for mut creature in &mut creatures {
        creature.ticks += 1;
        if !creature.ticks.is_multiple_of(creature.every) {
            continue;
        }
        let local = |entity: &Entity| {
            let found = transforms.get(*entity).unwrap();
            rig::Transform {
                translation: found.translation,
                rotation: found.rotation,
                scale: found.scale,
            }
        };
        let mut pose = Pose {
            transforms: creature.moved.iter().map(local).collect(),
        };
        pose.transforms[0].translation.x = (SPEED * now) as f32;
        pose.transforms[2].rotation = common::bend(0.05 * now);
        if creature.between == Between::Kept {
            for (entity, local) in creature.moved.iter().zip(&pose.transforms) {
                *transforms.get_mut(*entity).unwrap() = transform(local);
            }
        }
        let place = Similarity::IDENTITY;
        creature.poses.record(now, &pose, place).unwrap();
    }
}

/// The system of the README.
fn blend(
    time: Res<Time>,
    mut creatures: Query<(&mut SeldomPosed, Option<&mut PosedSurface>)>,
    mut transforms: Query<&mut Transform>,
) {
    let (now, dt) = (time.elapsed_secs_f64(), time.delta_secs_f64());
    for (mut creature, surface) in &mut creatures {
        if creature.between == Between::Kept {
            continue;
        }
        let Ok(motion) = creature.poses.tick(now, dt) else {
            continue;
        };
        for (entity, local) in creature.moved.iter().zip(&creature.poses.pose().transforms) {
            if let Ok(mut found) = transforms.get_mut(*entity) {
                found.set_if_neq(transform(local));
            }
        }
        if let (PoseMotion::Teleported, Some(mut surface)) = (motion, surface) {
            surface.forget_motion();
        }
    }
}

/// What a rider saw in each tick: how fast its support was and how much it shook, or `None` while it had none.
#[derive(Resource, Default)]
struct Felt(Vec<Option<(f64, f64)>>);

fn feel(climbers: Query<&ClimberState>, mut felt: ResMut<Felt>) {
    for state in &climbers {
        let on = state.support.is_some() && state.mode == ClimberMode::Standing;
        felt.0.push(on.then(|| {
            let speed = state.support_velocity.map_or(f64::INFINITY, |v| v.x);
            (speed, state.shake.length())
        }));
    }
}

/// A rider on a creature that is posed in every n-th tick. Gives the number of ticks in which it stood, of how many,
/// the worst error of its support's speed, as a share, and the hardest shake.
fn ride(every: u32, between: Between, frames: f64) -> (usize, usize, f64, f64) {
    let mut app: App = app_with(
        frames,
        (ClamberPlugins::default(), ClimberPlugin::default()),
    );
    app.add_systems(FixedUpdate, (animate, blend).chain());
    let lying = Transform::from_rotation(common::LYING).with_scale(Vec3::splat(10.0));
    let floor = limb(&mut app, lying, SkinnedCollider::each_tick());
    app.world_mut().entity_mut(floor.mesh).insert(SeldomPosed {
        moved: vec![floor.root, floor.joints[0], floor.joints[1]],
        poses: PoseTrack::default(),
        every,
        ticks: 0,
        between,
    });
    let updates = |seconds: f64| (seconds * frames) as u32;
    for _ in 0..updates(1.0) {
        app.update();
    }
    let root = app.world().get::<Transform>(floor.root).unwrap();
    let at = Transform::from_xyz(root.translation.x + 6.0, 2.5, 0.0);
    app.world_mut().spawn((Climber::colossus_climber(), at));
    for _ in 0..updates(2.0) {
        app.update();
    }
    app.init_resource::<Felt>()
        .add_systems(FixedPostUpdate, feel.after(ClamberSystems::Climb));
    for _ in 0..updates(1.0) {
        app.update();
    }
    let felt = &app.world().resource::<Felt>().0;
    let stood = || felt.iter().flatten();
    let off = stood().map(|(speed, _)| (speed / SPEED - 1.0).abs());
    (
        stood().count(),
        felt.len(),
        off.fold(0.0, f64::max),
        stood().map(|(_, shake)| *shake).fold(0.0, f64::max),
    )
}

#[test]
fn poses_in_every_second_to_fourth_tick_are_not_felt_if_they_are_blended() {
    for every in [2, 3, 4] {
        for frames in [30.0, 60.0, 144.0] {
            let case = format!("in every {every}. tick, {frames} frames a second");
            let (stood, ticks, off, shake) = ride(every, Between::Blended, frames);
            assert!(
                ticks > 60 && stood == ticks,
                "{case}: stood {stood} of {ticks}"
            );
            assert!(off < 0.01, "{case}: the speed is off by {off}");
            assert!(shake < 0.5, "{case}: {shake} m/s²");
        }
    }
}

#[test]
fn poses_in_every_third_tick_throw_riders_off_if_they_are_not() {
    let (stood, ticks, off, shake) = ride(3, Between::Kept, 60.0);
    assert!(
        stood < ticks || off > 0.5 && shake > 5.0,
        "{stood} of {ticks}, {off}, {shake}"
    );
}
