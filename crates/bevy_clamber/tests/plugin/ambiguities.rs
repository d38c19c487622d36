//! No system of this crate depends on an order that nobody has set, in any schedule, beside systems of an app.

use bevy_app::{App, FixedFirst, FixedPostUpdate, FixedUpdate, PostUpdate, PreUpdate, Update};
use bevy_clamber::clamber_fight::{Arena, ArenaConfig};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, Schedules};
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use super::common::{app_with, limb};

/// What many systems of an app do.
fn look(surfaces: SurfaceQuery, names: Query<&Name>) {
    let near = surfaces.closest_point(Vec3::ZERO, 9.0, &SurfaceFilter::default());
    let _ = near.map(|hit| names.get(hit.entity));
}

fn look_at_drawn(surfaces: DrawnSurfaceQuery) {
    let _ = surfaces.closest_point(Vec3::ZERO, 9.0, &SurfaceFilter::default());
}

fn rename(mut names: Query<&mut Name>) {
    for mut name in &mut names {
        name.set("renamed");
    }
}

fn strict(app: &mut App) {
    let mut schedules = app.world_mut().resource_mut::<Schedules>();
    for (_, schedule) in schedules.iter_mut() {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..ScheduleBuildSettings::default()
        });
    }
}

#[test]
fn no_systems_are_ambiguous_in_any_schedule() {
    let plugins = (
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberCameraPlugin,
        ClimberFigurePlugin,
        bevy_input::InputPlugin,
        ClimberControlsPlugin,
        RigPlayerPlugin::default(),
        ColossusPlugin::default(),
        ArenaPlugin::default(),
        bevy_gizmos::GizmoPlugin,
        SurfaceGizmosPlugin::default(),
        bevy_picking::PickingPlugin,
        SurfacePickingPlugin,
        SurfaceDiagnosticsPlugin::default(),
    );
    let mut app = app_with(64.0, plugins);
    app.add_systems(PreUpdate, (look, look_at_drawn))
        .add_systems(FixedFirst, (look, look_at_drawn, rename).chain())
        .add_systems(FixedUpdate, (look, look_at_drawn, rename).chain())
        .add_systems(
            FixedPostUpdate,
            (look, rename).chain().after(ClamberSystems::Climb),
        )
        .add_systems(Update, (look, look_at_drawn, rename).chain())
        .add_systems(PostUpdate, (look, rename).chain())
        .add_systems(PostUpdate, look_at_drawn.after(ClamberSystems::Sample));
    strict(&mut app);
    limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let hero = (
        Climber::default(),
        ClimberControls::default(),
        Transform::from_xyz(0.0, 9.0, 0.0),
    );
    let hero = app.world_mut().spawn(hero).id();
    app.world_mut().spawn(ClimberCamera::new(hero));
    app.insert_resource(FightArena::new(Arena::new(ArenaConfig::default()).unwrap()));
    for _ in 0..9 {
        app.update();
    }
}

#[test]
#[should_panic(expected = "ambig")]
fn an_ambiguity_would_be_seen() {
    let mut app = app_with(64.0, ClamberPlugins::default());
    app.add_systems(FixedPostUpdate, look);
    strict(&mut app);
    limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    for _ in 0..9 {
        app.update();
    }
}
