//! The scene around the creature, scaled to its size: window, camera, light, ground.

use bevy::app::PluginGroupBuilder;
use bevy::camera::Hdr;
use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;

use crate::creature::Creature;

/// Colour of the sky and of the fog.
const SKY: Color = Color::srgb(0.64, 0.80, 0.98);

/// Number of stones around the creature, which show how far the ground extends.
const STONES: u32 = 70;

/// Radians from one stone to the next, seen from the creature: the golden angle spreads them evenly.
const GOLDEN_ANGLE: f32 = 2.399_963;

pub fn window(defaults: impl PluginGroup) -> PluginGroupBuilder {
    defaults.set(WindowPlugin {
        primary_window: Some(Window {
            title: "clamber: left button shoots, right button and wheel move the camera".into(),
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
        .add_systems(Startup, |mut commands: Commands| {
            // With Hdr, sky and fog go through the same tone mapping.
            commands.spawn((Camera3d::default(), Hdr, Transform::default()));
        })
        .add_systems(Update, set.run_if(resource_added::<Creature>));
}

/// Sets the stage for a creature.
fn set(
    creature: Res<Creature>,
    camera: Single<Entity, With<Camera3d>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let radius = creature.radius();
    let from = Vec3::new(0.62, -0.12, 1.0).normalize();
    let distance = 1.9 * radius;
    let fog = DistanceFog {
        color: SKY,
        falloff: FogFalloff::from_visibility_squared(40.0 * radius),
        ..default()
    };
    let place = Transform::from_translation(creature.center + from * distance);
    let far = Projection::from(PerspectiveProjection {
        near: 0.002 * radius,
        ..default()
    });
    commands
        .entity(*camera)
        .insert((place.looking_at(creature.center, Vec3::Y), far, fog));

    let sun = Transform::default().looking_to(Vec3::new(0.3, -0.75, -0.75), Vec3::Y);
    let cascades = CascadeShadowConfigBuilder {
        minimum_distance: 0.05 * radius,
        first_cascade_far_bound: 1.2 * distance,
        maximum_distance: 6.0 * radius,
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

    let mut matt = |color| {
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: color,
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        }))
    };
    let (grass, stone) = (
        matt(Color::srgb(0.36, 0.40, 0.26)),
        matt(Color::srgb(0.5, 0.49, 0.46)),
    );
    let floor = Vec3::new(creature.center.x, creature.floor(), creature.center.z);
    let ground = Mesh3d(
        meshes.add(
            Plane3d::default()
                .mesh()
                .size(400.0 * radius, 400.0 * radius),
        ),
    );
    commands.spawn((ground, grass, Transform::from_translation(floor)));

    let block = Mesh3d(meshes.add(Cuboid::default()));
    for index in 0..STONES {
        let turn = Quat::from_rotation_y(index as f32 * GOLDEN_ANGLE);
        let away = radius * (2.5 + 0.14 * index as f32);
        // Many sizes, in no visible order.
        let size = radius * (0.07 + 0.08 * ((index * 7) % 11) as f32 / 11.0);
        let tall = size * (1.0 + ((index * 5) % 7) as f32 / 2.0);
        let place = Transform::from_translation(floor + turn * Vec3::Z * away)
            .with_rotation(turn * Quat::from_rotation_z(0.1))
            .with_scale(Vec3::new(size, 2.0 * tall, 0.8 * size));
        commands.spawn((block.clone(), stone.clone(), place));
    }
}
