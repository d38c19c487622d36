//! The valley: rolling ground with hills around it, and boulders that can be pushed. avian knows them as colliders.

use avian3d::prelude::{Collider, Friction, Mass, RigidBody};
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;

/// Length of each side, metres, and cells along each.
const SIZE: f32 = 480.0;
const CELLS: u32 = 160;

/// Distance from the middle at which the hills begin, metres.
const HILLS: f32 = 95.0;

const BOULDERS: u32 = 26;

/// Radians from one boulder to the next, seen from the middle: the golden angle spreads them evenly.
const GOLDEN_ANGLE: f32 = 2.399_963;

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn);
}

/// Height of the ground, metres.
pub fn height(x: f32, z: f32) -> f32 {
    let away = (x.hypot(z) - HILLS).max(0.0);
    let rolling = 0.12 * (0.07 * x).sin() * (0.06 * z).cos();
    let rugged = 1.0 + 0.35 * (0.045 * x + 0.8).sin() * (0.05 * z).cos();
    rolling + 0.009 * away * away * rugged
}

fn spawn(
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let (mesh, collider) = ground();
    let mut matt = |color| {
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: color,
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        }))
    };
    let (grass, stone) = (matt(Color::WHITE), matt(Color::srgb(0.46, 0.45, 0.42)));
    commands.spawn((Mesh3d(meshes.add(mesh)), grass, RigidBody::Static, collider));
    let ball = Mesh3d(
        meshes.add(
            Sphere::new(1.0)
                .mesh()
                .ico(3)
                .unwrap_or_else(|_| Sphere::new(1.0).into()),
        ),
    );
    for index in 0..BOULDERS {
        let turn = Quat::from_rotation_y(index as f32 * GOLDEN_ANGLE);
        let place = turn * Vec3::Z * (12.0 + 3.0 * index as f32);
        let radius = 0.35 + 0.12 * ((index * 7) % 11) as f32;
        let at = place.with_y(height(place.x, place.z) + radius + 0.1);
        commands.spawn((
            ball.clone(),
            stone.clone(),
            Transform::from_translation(at).with_scale(Vec3::splat(radius)),
            RigidBody::Dynamic,
            // It is scaled by the entity's transform, as the mesh is.
            Collider::sphere(1.0),
            Mass(300.0 * radius * radius * radius),
            Friction::new(0.9),
        ));
    }
}

/// The ground as it is drawn and as it is touched.
fn ground() -> (Mesh, Collider) {
    let side = CELLS + 1;
    let (mut positions, mut colors) = (Vec::new(), Vec::new());
    for index in 0..side * side {
        let at = |step: u32| (step as f32 / CELLS as f32 - 0.5) * SIZE;
        let (x, z) = (at(index % side), at(index / side));
        let y = height(x, z);
        positions.push(Vec3::new(x, y, z));
        // Grass, in patches, and rock on the hills.
        let patch = 0.5 + 0.5 * (0.21 * x).sin() * (0.17 * z + 1.0).sin();
        let grass = Vec3::new(0.10, 0.16, 0.05).lerp(Vec3::new(0.19, 0.22, 0.08), patch);
        let rock = Vec3::new(0.26, 0.23, 0.19);
        let color = grass.lerp(rock, ((y - 4.0) / 30.0).clamp(0.0, 1.0));
        colors.push([color.x, color.y, color.z, 1.0]);
    }
    let corner = |cell: u32| cell / CELLS * side + cell % CELLS;
    let triangles: Vec<[u32; 3]> = (0..CELLS * CELLS)
        .flat_map(|cell| {
            let a = corner(cell);
            let [b, c, d] = [a + 1, a + side, a + side + 1];
            [[a, c, b], [b, c, d]]
        })
        .collect();
    let collider = Collider::trimesh(positions.clone(), triangles.clone());
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
    .with_inserted_indices(Indices::U32(triangles.concat()));
    mesh.compute_normals();
    (mesh, collider)
}
