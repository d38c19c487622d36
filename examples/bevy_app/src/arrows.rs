//! Arrows: their looks, and how they are attached to skin.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

use crate::creature::Creature;

/// Length of an arrow, relative to half of the creature's height, so that it can be seen on a giant, too.
const LENGTH: f32 = 0.26;

/// Least half height that is assumed of a creature, relative to its radius.
const LOWEST: f32 = 0.3;

/// Meshes of an arrow of length 1, which flies along -Y and whose point is at the origin.
#[derive(Resource)]
struct Looks {
    shaft: (Mesh3d, MeshMaterial3d<StandardMaterial>),
    feather: (Mesh3d, MeshMaterial3d<StandardMaterial>),
}

/// Marks an arrow, and stores the point in the world that it hit.
#[derive(Component)]
pub struct Arrow {
    pub hit: Vec3,
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

/// Shoots arrows.
#[derive(SystemParam)]
pub struct Bow<'w, 's> {
    surfaces: SurfaceQuery<'w, 's>,
    creature: Option<Res<'w, Creature>>,
    looks: Res<'w, Looks>,
    commands: Commands<'w, 's>,
}

impl Bow<'_, '_> {
    /// Attaches an arrow to the first point of skin along a ray.
    pub fn shoot(&mut self, ray: Ray3d) {
        let anywhere = SurfaceFilter::default();
        if let Some(hit) = self.surfaces.cast_ray(ray, f32::INFINITY, &anywhere)
            && let Ok(anchor) = self.surfaces.anchor_at(&hit)
        {
            self.stick(&anchor, hit.point, ray.direction);
        }
    }

    /// Attaches an arrow to a point of skin, which is at `point` in the world. It keeps the direction of its flight.
    pub fn stick(&mut self, there: &SurfaceAnchor, point: Vec3, direction: Dir3) {
        let (Some(creature), Some(surface)) = (&self.creature, self.surfaces.get(there.surface))
        else {
            return;
        };
        let Ok(anchor) = there.anchor() else {
            return;
        };
        let rotation = Quat::from_rotation_arc(Vec3::Y, -*direction);
        let half_height = creature.half_size.y.max(LOWEST * creature.radius());
        let arrow = (
            SurfaceAnchor::new(there.surface, surface, anchor, rotation),
            Arrow { hit: point },
            Transform::from_translation(point)
                .with_rotation(rotation)
                .with_scale(Vec3::splat(LENGTH * half_height)),
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
