//! What the library does, by a key: which skin was touched, anchors, frames a second, the hero's state.

use core::fmt::Write;

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore, FrameTimeDiagnosticsPlugin};
use bevy::gizmos::config::{GizmoConfig, GizmoConfigStore};
use bevy::prelude::*;
use bevy::text::FontSize;
use bevy_clamber::prelude::*;

use crate::hero::Hero;

#[derive(Component)]
struct Overlay;

pub fn plugin(app: &mut App) {
    app.add_plugins((
        FrameTimeDiagnosticsPlugin::default(),
        SurfaceDiagnosticsPlugin::default(),
        SurfaceGizmosPlugin::default(),
    ))
    .insert_gizmo_config(
        SurfaceGizmos {
            parts: false,
            ..default()
        },
        GizmoConfig {
            enabled: false,
            depth_bias: -1.0,
            ..default()
        },
    )
    .add_systems(Startup, spawn)
    .add_systems(Update, (toggle, write).chain());
}

fn spawn(mut commands: Commands) {
    commands.spawn((
        Text::default(),
        TextFont::from_font_size(FontSize::Vh(2.0)),
        TextShadow::default(),
        Node {
            position_type: PositionType::Absolute,
            top: vh(6),
            left: px(14),
            ..default()
        },
        Overlay,
    ));
}

fn toggle(keys: Option<Res<ButtonInput<KeyCode>>>, mut gizmos: ResMut<GizmoConfigStore>) {
    if keys.is_some_and(|keys| keys.just_pressed(KeyCode::F3)) {
        let (config, _) = gizmos.config_mut::<SurfaceGizmos>();
        config.enabled = !config.enabled;
    }
}

fn write(
    gizmos: Res<GizmoConfigStore>,
    diagnostics: Res<DiagnosticsStore>,
    heroes: Query<&ClimberState, With<Hero>>,
    mut text: Single<&mut Text, With<Overlay>>,
) {
    text.0.clear();
    if !gizmos.config::<SurfaceGizmos>().0.enabled {
        return;
    }
    let mut line = |name: &str, path: &DiagnosticPath| {
        let value = diagnostics
            .get(path)
            .and_then(|diagnostic| diagnostic.smoothed());
        // A `String` can always be written to.
        let _ = writeln!(text.0, "{name}: {:.1}", value.unwrap_or_default());
    };
    line("frames a second", &FrameTimeDiagnosticsPlugin::FPS);
    line("surfaces", &SurfaceDiagnosticsPlugin::SURFACES);
    line(
        "clusters touched a tick",
        &SurfaceDiagnosticsPlugin::CLUSTERS_TOUCHED,
    );
    line(
        "vertices skinned a tick",
        &SurfaceDiagnosticsPlugin::VERTICES_SKINNED,
    );
    line(
        "triangles tested a tick",
        &SurfaceDiagnosticsPlugin::TRIANGLES_TESTED,
    );
    for state in &heroes {
        let (mode, speed, shake) = (state.mode, state.velocity.length(), state.shake.length());
        let _ = writeln!(
            text.0,
            "{mode:?} at {speed:.1} m/s, shaken by {shake:.1} m/s²"
        );
    }
}
