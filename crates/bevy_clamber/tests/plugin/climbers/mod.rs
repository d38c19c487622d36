//! Climbers on entities: spawned, told what to do, moved, changed and removed by the app in any tick.

mod changes;
mod input;
mod supports;

use std::time::Duration;

use bevy_app::{App, FixedPostUpdate, FixedUpdate, PreUpdate, Update};
use bevy_asset::Assets;
use bevy_clamber::clamber_climber::{ClimberConfig, ClimberMode, ClimberObstacle, CustomMode};
use bevy_clamber::clamber_climber::{ModeContext, NextMode};
use bevy_clamber::events::{
    ClimberChangedMode, ClimberGrabbed, ClimberHurt, ClimberJumped, ClimberLanded,
    ClimberLostFooting, ClimberModeReported,
};
use bevy_clamber::prelude::*;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_time::{Time, TimeUpdateStrategy, Virtual};
use bevy_transform::components::Transform;

use super::common::{self, Limb, app_with, limb, limb_mesh, wait, wait_with};

/// Metres a second that the creature moves along X.
const SPEED: f32 = 2.0;

/// The upper side of the creature, metres.
const TOP: f64 = 2.0;

/// Radius of the climber's ball.
const RADIUS: f64 = 0.4;

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
    let lying = Transform::from_rotation(common::LYING);
    limb(app, lying.with_scale(Vec3::splat(10.0)), collider)
}

fn climber(app: &mut App, at: Vec3) -> Entity {
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    app.world_mut().spawn(climber).id()
}

fn state(app: &App, climber: Entity) -> ClimberState {
    *app.world().get::<ClimberState>(climber).unwrap()
}

fn stands(app: &App, climber: Entity) -> bool {
    state(app, climber).mode == ClimberMode::Standing
}

fn updates(app: &mut App, count: usize) {
    for _ in 0..count {
        app.update();
    }
}

/// A climber that stands on a still floor.
fn standing(rate: f64) -> (App, Limb, Entity) {
    let mut app = climbing(rate);
    let floor = floor(&mut app, SkinnedCollider::default());
    let climber = climber(&mut app, Vec3::new(10.0, 2.5, 0.0));
    updates(&mut app, (0.5 * rate) as usize);
    assert!(stands(&app, climber));
    (app, floor, climber)
}

fn input(app: &mut App, climber: Entity) -> Mut<'_, ClimberInput> {
    app.world_mut().get_mut::<ClimberInput>(climber).unwrap()
}

#[derive(Resource, Default)]
struct Told(Vec<String>);
