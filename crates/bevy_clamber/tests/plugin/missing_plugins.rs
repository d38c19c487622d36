//! A plugin that is missing is named when the app starts.

use std::panic::{AssertUnwindSafe, catch_unwind};

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::AssetPlugin;
use bevy_clamber::prelude::*;
use bevy_gizmos::GizmoPlugin;
use bevy_mesh::MeshPlugin;
use bevy_picking::PickingPlugin;
use bevy_time::TimePlugin;
use bevy_transform::TransformPlugin;

/// Adds one of all plugins that an app may need. `MeshPlugin` and `GizmoPlugin` need assets.
fn add(app: &mut App, name: &str) {
    match name {
        "TaskPoolPlugin" => app.add_plugins(TaskPoolPlugin::default()),
        "TimePlugin" => app.add_plugins(TimePlugin),
        "TransformPlugin" => app.add_plugins(TransformPlugin),
        "AssetPlugin" => app.add_plugins(AssetPlugin::default()),
        "MeshPlugin" => app.add_plugins(MeshPlugin),
        "GizmoPlugin" => app.add_plugins(GizmoPlugin),
        "PickingPlugin" => app.add_plugins(PickingPlugin),
        "ClamberPlugins" => app.add_plugins(ClamberPlugins::default()),
        "ClimberPlugin" => app.add_plugins(ClimberPlugin::default()),
        "SurfaceGizmosPlugin" => app.add_plugins(SurfaceGizmosPlugin::default()),
        "SurfacePickingPlugin" => app.add_plugins(SurfacePickingPlugin),
        "SurfaceDiagnosticsPlugin" => app.add_plugins(SurfaceDiagnosticsPlugin::default()),
        _ => panic!("{name}"),
    };
}

const ALL: [&str; 12] = [
    "TaskPoolPlugin",
    "TimePlugin",
    "TransformPlugin",
    "AssetPlugin",
    "MeshPlugin",
    "GizmoPlugin",
    "PickingPlugin",
    "ClamberPlugins",
    "ClimberPlugin",
    "SurfaceGizmosPlugin",
    "SurfacePickingPlugin",
    "SurfaceDiagnosticsPlugin",
];

/// The message with which an app with these plugins ends; empty if it starts.
fn start(plugins: impl Iterator<Item = &'static str>) -> String {
    let started = catch_unwind(AssertUnwindSafe(|| {
        let mut app = App::new();
        plugins.for_each(|name| add(&mut app, name));
        app.finish();
        app.cleanup();
        app.update();
    }));
    let Err(message) = started else {
        return String::new();
    };
    let text = message.downcast_ref::<String>().cloned();
    text.or(message
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned()))
        .unwrap()
}

#[test]
fn a_missing_plugin_is_named() {
    assert_eq!(start(ALL.into_iter()), "");
    // Task pools are global: once made, they are there for all apps of the process.
    for missing in [
        "TimePlugin",
        "MeshPlugin",
        "GizmoPlugin",
        "PickingPlugin",
        "ClamberPlugins",
    ] {
        let message = start(ALL.into_iter().filter(|name| *name != missing));
        assert!(message.contains(missing), "{missing}: {message}");
        assert!(message.contains("clamber's"), "{missing}: {message}");
    }
    // `MeshPlugin` and `GizmoPlugin` themselves end without assets.
    let few = ["TaskPoolPlugin", "TimePlugin", "ClamberPlugins"];
    let message = start(few.into_iter());
    assert!(message.contains("AssetPlugin"), "{message}");
    // A server has no use for transforms of a picture.
    let without = ALL.into_iter().filter(|name| *name != "TransformPlugin");
    assert_eq!(start(without), "");
}
