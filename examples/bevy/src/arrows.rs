//! Arrows: their looks, and how they are attached to skin.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

/// Length of an arrow, metres: longer than real ones, to be seen from afar.
const LENGTH: f32 = 1.4;

/// Meshes of an arrow of length 1, which flies along -Y and whose point is at the origin.
#[derive(Resource)]
struct Looks {
    shaft: (Mesh3d, MeshMaterial3d<StandardMaterial>),
    feather: (Mesh3d, MeshMaterial3d<StandardMaterial>),
}

/// Marks an arrow.
#[derive(Component)]
pub struct Arrow {
    /// The point in the world that it hit.
    pub hit: Vec3,
    /// How far that was from the pointer in the picture, pixels.
    pub missed: f32,
}

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, make_looks);
}

fn make_looks(
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let mut matt = |color| {
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: color,
            perceptual_roughness: 0.9,
            ..default()
        }))
    };
    let (wood, red) = (Color::srgb(0.93, 0.76, 0.46), Color::srgb(0.95, 0.10, 0.07));
    commands.insert_resource(Looks {
        shaft: (Mesh3d(meshes.add(Cylinder::new(0.022, 1.0))), matt(wood)),
        feather: (
            Mesh3d(meshes.add(Cuboid::new(0.012, 0.28, 0.13))),
            matt(red),
        ),
    });
}

/// Sticks arrows.
#[derive(SystemParam)]
pub struct Bow<'w, 's> {
    surfaces: SurfaceQuery<'w, 's>,
    looks: Res<'w, Looks>,
    commands: Commands<'w, 's>,
}

impl Bow<'_, '_> {
    /// Attaches an arrow to a point of skin, which is at `point` in the world. It keeps the direction of its flight.
    pub fn stick(&mut self, there: &SurfaceAnchor, arrow: Arrow, direction: Dir3) {
        let point = arrow.hit;
        let Some(surface) = self.surfaces.get(there.surface) else {
            return;
        };
        let Ok(anchor) = there.anchor() else {
            return;
        };
        let rotation = Quat::from_rotation_arc(Vec3::Y, -*direction);
        let arrow = (
            SurfaceAnchor::new(there.surface, surface, anchor, rotation),
            arrow,
            Transform::from_translation(point)
                .with_rotation(rotation)
                .with_scale(Vec3::splat(LENGTH)),
            Visibility::default(),
        );
        self.commands.spawn(arrow).with_children(|parts| {
            // A tenth of it is in the skin.
            parts.spawn((self.looks.shaft.clone(), Transform::from_xyz(0.0, 0.4, 0.0)));
            for side in 0..3 {
                let around = Quat::from_rotation_y(side as f32 * core::f32::consts::FRAC_PI_3);
                let at = Transform::from_xyz(0.0, 0.74, 0.0).with_rotation(around);
                parts.spawn((self.looks.feather.clone(), at));
            }
        });
    }
}
