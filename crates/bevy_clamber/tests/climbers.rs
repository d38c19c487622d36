//! Climbers on entities: spawned, stepped on all kinds of obstacles, told of, moved and removed by the app.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod common;

use std::f32::consts::FRAC_PI_2;
use std::time::Duration;

use bevy_app::{App, FixedUpdate, Update};
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::events::{ClimberChangedMode, ClimberJumped, ClimberLanded};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{Time, TimeUpdateStrategy};
use bevy_transform::components::Transform;
use common::{Limb, app_with, limb};

/// Metres a second that the limb moves along X.
const SPEED: f32 = 2.0;

fn climbing(rate: f64) -> App {
    app_with(rate, (ClamberPlugins::default(), ClimberPlugin::default()))
}

#[derive(Component)]
struct Moving;

fn carry(time: Res<Time>, mut roots: Query<&mut Transform, With<Moving>>) {
    for mut root in &mut roots {
        root.translation.x += SPEED * time.delta_secs();
    }
}

/// A limb ten times as large that lies along X, from 0 to 20 m: its upper side is a floor of 4 m, at a height of 2 m.
fn floor(app: &mut App, collider: SkinnedCollider) -> Limb {
    let lying = Transform::from_rotation(Quat::from_rotation_z(-FRAC_PI_2));
    limb(app, lying.with_scale(Vec3::splat(10.0)), collider)
}

fn climber(app: &mut App, at: Vec3) -> Entity {
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    app.world_mut().spawn(climber).id()
}

fn state(app: &App, climber: Entity) -> ClimberState {
    *app.world().get::<ClimberState>(climber).unwrap()
}

fn updates(app: &mut App, count: usize) {
    for _ in 0..count {
        app.update();
    }
}

#[derive(Resource, Default)]
struct Told(Vec<String>);

#[test]
fn a_climber_lands_on_skin_is_carried_and_tells_of_it() {
    for (collider, schedule) in [
        (SkinnedCollider::default(), true),
        (SkinnedCollider::each_tick(), false),
    ] {
        let mut app = climbing(64.0);
        if schedule {
            app.add_systems(Update, carry);
        } else {
            app.add_systems(FixedUpdate, carry);
        }
        app.init_resource::<Told>();
        app.add_observer(|landed: On<ClimberLanded>, mut told: ResMut<Told>| {
            told.0.push(format!("landed on {:?}", landed.ground));
        });
        let floor = floor(&mut app, collider);
        app.world_mut().entity_mut(floor.root).insert(Moving);
        let climber = climber(&mut app, Vec3::new(10.0, 4.0, 0.0));
        updates(&mut app, 120);
        let before = state(&app, climber);
        println!("{before:?}");
        println!("{:?}", app.world().resource::<Told>().0);
        let transform = app.world().get::<Transform>(climber).unwrap();
        println!(
            "{transform:?} root {:?}",
            app.world().get::<Transform>(floor.root)
        );
    }
}
