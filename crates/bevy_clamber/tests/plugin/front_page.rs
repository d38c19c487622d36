//! An app written from the crate's README alone: an arrow is attached to an animated fox and follows it.

use std::path::PathBuf;
use std::time::Duration;

use bevy_app::prelude::*;
use bevy_asset::prelude::*;
use bevy_clamber::clamber_gltf;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::prelude::*;
use bevy_mesh::prelude::*;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_shape::prelude::*;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;
use clamber_scenes::test_data;

#[derive(Resource)]
struct File(PathBuf);

fn spawn_fox(
    file: Res<File>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut inverse_bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
) -> Result {
    let model = clamber_gltf::load(&file.0)?;
    let rig = RigAssets::new(model, &mut meshes, &mut inverse_bindposes)?;
    let fox = rig.spawn(&mut commands, Transform::IDENTITY);
    commands.entity(fox.root).insert(RigPlayer::new("Walk"));
    for mesh in fox.meshes {
        commands.entity(mesh).insert(SkinnedCollider::each_tick());
    }
    Ok(())
}

fn shoot(surfaces: SurfaceQuery, mut commands: Commands, arrows: Query<&SurfaceAnchor>) {
    // The fox in the file is about 150 units long, and faces along Z.
    let ray = Ray3d::new(Vec3::new(200.0, 45.0, 0.0), Dir3::NEG_X);
    if let Some(hit) = surfaces.cast_ray(ray, 500.0, &SurfaceFilter::default())
        && let Ok(anchor) = surfaces.anchor_at(&hit)
        && arrows.is_empty()
    {
        commands.spawn(anchor);
    }
}

/// Position of the arrow in each frame, and its distance from the nearest skin in the last tick.
#[derive(Resource, Default)]
struct Seen(Vec<(Vec3, f32)>);

fn watch(
    arrow: Query<&GlobalTransform, With<SurfaceAnchor>>,
    surfaces: SurfaceQuery,
    mut seen: ResMut<Seen>,
) {
    let Ok(arrow) = arrow.single() else {
        return;
    };
    let point = arrow.translation();
    let skin = surfaces.closest_point(point, f32::INFINITY, &SurfaceFilter::default());
    seen.0.push((point, skin.unwrap().distance));
}

#[test]
fn an_arrow_sticks_in_a_walking_fox() {
    let Some(file) = test_data::file("front_page", "models/Fox.glb") else {
        return;
    };
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        bevy_mesh::MeshPlugin,
        ClamberPlugins::default(),
        RigPlayerPlugin::default(),
    ))
    .insert_resource(File(file))
    .init_resource::<Seen>()
    .add_systems(Startup, spawn_fox)
    .add_systems(FixedUpdate, shoot)
    .add_systems(Last, watch)
    // One tick per frame, so that queries see the pose that is drawn.
    .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.finish();
    app.cleanup();
    for _ in 0..1_000 {
        app.update();
        if app.world().resource::<Seen>().0.len() > 192 {
            break;
        }
        // The collider is built on other threads.
        std::thread::sleep(Duration::from_millis(1));
    }
    let seen = &app.world().resource::<Seen>().0;
    assert!(seen.len() > 192, "{}", seen.len());
    // Without the frame in which the arrow is spawned, since it is not placed yet.
    let seen = &seen[1..];
    let worst = seen.iter().map(|(_, off)| *off).fold(0.0, f32::max);
    assert!(worst < 1e-3, "{worst}");
    let way: f32 = seen
        .windows(2)
        .map(|pair| (pair[1].0 - pair[0].0).length())
        .sum();
    println!(
        "{way} units in {} ticks, {worst:.1e} off the skin",
        seen.len()
    );
    assert!(way > 10.0, "{way}");
}
