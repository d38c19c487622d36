//! Window, camera and light.

use bevy::app::PluginGroupBuilder;
use bevy::camera::Hdr;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

/// Colour of the sky and of the fog.
const SKY: Color = Color::srgb(0.64, 0.80, 0.98);

pub fn window(defaults: impl PluginGroup) -> PluginGroupBuilder {
    defaults.set(WindowPlugin {
        primary_window: Some(Window {
            title: "clamber: climb the creature".into(),
            ..default()
        }),
        ..default()
    })
}

pub fn plugin(app: &mut App) {
    app.insert_resource(ClearColor(SKY))
        .insert_resource(GlobalAmbientLight {
            color: SKY,
            brightness: 900.0,
            ..default()
        })
        .add_systems(Startup, set);
}

fn set(mut commands: Commands) {
    let fog = DistanceFog {
        color: SKY,
        falloff: FogFalloff::from_visibility_squared(900.0),
        ..default()
    };
    // With Hdr, sky and fog go through the same tone mapping. The camera looks at the valley until there is a hero.
    let place = Transform::from_xyz(0.0, 12.0, 60.0).looking_at(Vec3::Y * 10.0, Vec3::Y);
    commands.spawn((Camera3d::default(), Hdr, place, fog, IsDefaultUiCamera));
    let sun = Transform::default().looking_to(Vec3::new(0.35, -0.6, 0.72), Vec3::Y);
    let cascades = CascadeShadowConfigBuilder {
        first_cascade_far_bound: 18.0,
        maximum_distance: 220.0,
        num_cascades: 3,
        ..default()
    };
    let light = DirectionalLight {
        color: Color::srgb(1.0, 0.93, 0.82),
        illuminance: 11_000.0,
        shadow_maps_enabled: true,
        ..default()
    };
    commands.spawn((light, sun, cascades.build()));
}
