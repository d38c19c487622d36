use std::thread::sleep;
use std::time::{Duration, Instant};

use bevy_app::prelude::*;
use bevy_asset::prelude::*;
use bevy_clamber::clamber_gltf;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_mesh::{Mesh, MeshPlugin};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

fn main() {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
        ClamberPlugins::default(),
        RigPlayerPlugin::default(),
    ))
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1)) // each update is one tick
    .add_systems(Startup, spawn)
    .add_systems(FixedUpdate, stick);
    app.finish();
    app.cleanup();

    // Colliders are built on other threads. The arrow sticks as soon as one is ready.
    let mut arrows = app.world_mut().query_filtered::<&Transform, With<SurfaceAnchor>>();
    let start = Instant::now();
    while arrows.iter(app.world()).next().is_none() {
        assert!(start.elapsed() < Duration::from_secs(100), "no collider was built");
        app.update();
        sleep(Duration::from_millis(1));
    }
    let mut place = |updates: usize| {
        for _ in 0..updates {
            app.update();
        }
        let mut arrows = arrows.iter(app.world());
        arrows.next().map(|transform| transform.translation)
    };
    let (before, after) = (place(1), place(20));
    assert!(before.is_some() && after.is_some(), "the arrow is gone");
    assert_ne!(before, after, "the giant walks, but the arrow stands still");
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut inverse_bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
) -> Result {
    let model = clamber_gltf::load("colossus.glb")?; // from `assets` in clamber's repository
    let rig = RigAssets::new(model, &mut meshes, &mut inverse_bindposes)?;
    let giant = rig.spawn(&mut commands, Transform::IDENTITY); // as often as you like
    commands.entity(giant.root).insert(RigPlayer::new("walk")); // plays in FixedUpdate
    for mesh in giant.meshes {
        commands.entity(mesh).insert(SkinnedCollider::each_tick());
    }
    Ok(())
}

/// Sticks one arrow in the skin that is nearest to a point above the giant.
fn stick(surfaces: SurfaceQuery, mut commands: Commands, arrows: Query<&SurfaceAnchor>) {
    let above = Vec3::new(0.0, 50.0, 0.0);
    if let Some(hit) = surfaces.closest_point(above, f32::INFINITY, &SurfaceFilter::default())
        && let Ok(anchor) = surfaces.anchor_at(&hit)
        && arrows.is_empty()
    {
        commands.spawn(anchor);
    }
}
