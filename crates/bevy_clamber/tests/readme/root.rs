use bevy::{mesh::skinning::SkinnedMesh, prelude::*};
use bevy_clamber::clamber_world::HalfSpace;
use bevy_clamber::prelude::*;

/// Give it to your app: `.add_plugins(climbing)`. All skinned meshes that it spawns can be stood on.
fn climbing(app: &mut App) {
    app.add_plugins((ClamberPlugins::default(), ClimberPlugin::default(), ClimberCameraPlugin))
        .add_observer(|skin: On<Add<SkinnedMesh>>, mut commands: Commands| {
            let fur = ColliderTag(SurfaceTag::new(SurfaceKind::Fur)); // can be gripped as well
            commands.entity(skin.entity).insert((SkinnedCollider::default(), fur));
        })
        .add_systems(Startup, |mut commands: Commands| {
            commands.spawn(CustomObstacle::new(HalfSpace::below(0.0))); // ground, if no engine has any
            let hero = (Climber::colossus_climber(), Transform::from_xyz(0.0, 12.0, 0.0));
            let hero = commands.spawn(hero).id(); // insert a mesh or a `ClimberFigure`, to see it
            commands.spawn(ClimberCamera::new(hero)); // with a `Camera3d`
        });
}
