use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ClamberPlugins::default()))
        .add_observer(add_surface)
        .add_systems(FixedUpdate, shoot)
        .run();
}

/// Makes every skinned mesh a surface when it is spawned.
fn add_surface(skin: On<Add<SkinnedMesh>>, mut commands: Commands) {
    commands.entity(skin.entity).insert(SkinnedCollider::default());
}

/// Shoots one arrow along -Z: an entity whose `Transform` follows the point of skin that it hit.
fn shoot(surfaces: SurfaceQuery, mut commands: Commands, arrows: Query<&SurfaceAnchor>) {
    let ray = Ray3d::new(Vec3::new(0.0, 1.0, 9.0), Dir3::NEG_Z);
    if let Some(hit) = surfaces.cast_ray(ray, 50.0, &SurfaceFilter::default())
        && let Ok(anchor) = surfaces.anchor_at(&hit)
        && arrows.is_empty()
    {
        assert!(hit.distance <= 50.0);
        commands.spawn(anchor);
    }
}
