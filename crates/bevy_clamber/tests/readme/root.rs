use bevy::{mesh::skinning::SkinnedMesh, prelude::*};
use bevy_clamber::prelude::*;

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, ClamberPlugins::default(), ClimberPlugin::default()))
        .add_observer(|skin: On<Add<SkinnedMesh>>, mut commands: Commands| {
            commands.entity(skin.entity).insert(SkinnedCollider::default());
        })
        .add_systems(Startup, |mut commands: Commands| {
            commands.spawn((Climber::colossus_climber(), Transform::from_xyz(0.0, 12.0, 0.0)));
        })
        .run();
}
