use avian3d::prelude::{Collider, ColliderDensity, PhysicsPlugins, RigidBody};
use bevy::prelude::*;
use bevy_clamber::events::ClimberTumbled;
use bevy_clamber::prelude::*;

fn main() {
    App::new().add_plugins((DefaultPlugins, falling_crate)).run();
}

fn falling_crate(app: &mut App) {
    app.add_plugins((ClamberPlugins::default(), ClimberPlugin::default()))
        .add_plugins((PhysicsPlugins::default(), AvianProxyPlugin::default()))
        .add_systems(Startup, spawn)
        .add_observer(|fell: On<ClimberTumbled>| println!("knocked down by {:?}", fell.by));
}

fn spawn(mut commands: Commands) {
    let ground = Collider::cuboid(100.0, 1.0, 100.0); // whole edges
    commands.spawn((RigidBody::Static, ground, Transform::from_xyz(0.0, -0.5, 0.0)));
    let place = Transform::from_xyz(0.0, 0.4, 0.0);
    commands.spawn((Climber::colossus_climber(), AvianProxy, place));
    let load = (
        RigidBody::Dynamic,
        Collider::cuboid(0.6, 0.6, 0.6),
        ColliderDensity(278.0), // 60 kg; one of 10 kg rests on the climber's head
    );
    commands.spawn((load, Transform::from_xyz(0.0, 2.4, 0.0)));
    let eye = Transform::from_xyz(0.0, 2.0, 8.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((Camera3d::default(), eye));
}
