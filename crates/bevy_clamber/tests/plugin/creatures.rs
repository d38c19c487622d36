//! Creatures that `clamber_gltf` loads: spawning, playing clips, surfaces.

use std::path::PathBuf;
use std::time::Duration;

use bevy_app::{App, FixedPostUpdate, PostUpdate};
use bevy_asset::Assets;
use bevy_clamber::clamber_surface::rig::{Joint, Marker, Playback, Skeleton};
use bevy_clamber::clamber_surface::skin::skin;
use bevy_clamber::prelude::*;
use bevy_clamber::{RigAssets, TooManyJoints};
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_gltf::Model;
use clamber_scenes::test_data;

use super::common::{app, app_with};

const COLOSSUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");

fn assets(app: &mut App, model: Model) -> Result<RigAssets, TooManyJoints> {
    let world = app.world_mut();
    world.resource_scope(|world, mut meshes: Mut<'_, Assets<Mesh>>| {
        let mut inverse_bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        RigAssets::new(model, &mut meshes, &mut inverse_bindposes)
    })
}

fn spawn(app: &mut App, assets: &RigAssets, place: Transform) -> SpawnedRig {
    let spawned = assets.spawn(&mut app.world_mut().commands(), place);
    app.world_mut().flush();
    spawned
}

/// Inserts a collider on every mesh, and waits for the surfaces.
fn surfaces(app: &mut App, spawned: &SpawnedRig, collider: SkinnedCollider) {
    for mesh in &spawned.meshes {
        app.world_mut().entity_mut(*mesh).insert(collider);
    }
    let built = |app: &App, mesh: &Entity| {
        let status = app.world().get::<ColliderStatus>(*mesh).unwrap();
        assert!(!matches!(status, ColliderStatus::Failed(_)), "{status:?}");
        matches!(status, ColliderStatus::Ready)
    };
    // The colliders are large, and are built on other threads: a minute is enough.
    for _ in 0..60_000 {
        app.update();
        if spawned.meshes.iter().all(|mesh| built(app, mesh)) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("the colliders were not built in time");
}

/// Spawns two creatures in an app whose frames last `1 / rate` seconds, and plays a clip on the first. In each tick,
/// checks the vertices of its first mesh against the rig's own sampling and skinning at the player's time, relative to
/// the creature's size, and the player's time against the number of ticks.
fn check_ticks(file: PathBuf, clip: &str, rate: f64) {
    #[derive(Resource)]
    struct Watch {
        model: Model,
        clip: String,
        mesh: Entity,
        seen: usize,
    }
    let model = clamber_gltf::load(file).unwrap();
    let mut app = app_with(
        rate,
        (ClamberPlugins::default(), RigPlayerPlugin::default()),
    );
    let assets = assets(&mut app, model.clone()).unwrap();
    let place = Transform::from_xyz(500.0, -20.0, 70.0).with_scale(Vec3::splat(2.0));
    let [played, still] = [place, Transform::IDENTITY].map(|at| spawn(&mut app, &assets, at));
    for spawned in [&played, &still] {
        surfaces(&mut app, spawned, SkinnedCollider::each_tick());
    }
    let check = |mut watch: ResMut<Watch>,
                 time: Res<Time<Fixed>>,
                 players: Query<&RigPlayer>,
                 surfaces: Query<&PosedSurface>| {
        let surface = surfaces.get(watch.mesh).unwrap();
        let player = players.single().unwrap();
        let elapsed = time.elapsed_secs_f64();
        let rest = watch.model.rig.skeleton.rest_pose();
        let clip = watch.model.rig.clip(&watch.clip).unwrap();
        let pose = clip.sample(&rest, player.time, Playback::Loop).unwrap();
        let palette = watch.model.rig.skeleton.palette(&pose).unwrap();
        let expected = skin(surface.mesh(), palette.matrices()).unwrap();
        let mut found = Vec::new();
        surface.skin_all(&mut found);
        let size = expected.iter().map(|p| p.length()).fold(0.0, f32::max);
        for (found, expected) in found.iter().zip(&expected) {
            let off = (*found - *expected).length() / size;
            assert!(off < 1e-5, "{elapsed} s: {found} not {expected}");
        }
        // The player starts in the first tick that sees it.
        let expected = (watch.seen as f64 + 1.0) * time.delta_secs_f64();
        let expected = expected.rem_euclid(clip.duration());
        assert!((player.time - expected).abs() < 1e-9, "{elapsed}");
        watch.seen += 1;
    };
    let clip = clip.to_owned();
    app.world_mut()
        .entity_mut(played.root)
        .insert(RigPlayer::new(&clip));
    app.insert_resource(Watch {
        model,
        clip,
        mesh: played.meshes[0],
        seen: 0,
    })
    .add_systems(FixedPostUpdate, check.after(ClamberSystems::Pose));
    for _ in 0..rate as usize {
        app.update();
    }
    let seen = app.world().resource::<Watch>().seen;
    assert!((62..=66).contains(&seen), "{seen}");
    // The other creature stands still, and has the same mesh assets.
    let ids = |spawned: &SpawnedRig| {
        let mesh = spawned.meshes[0];
        app.world().get::<bevy_mesh::Mesh3d>(mesh).unwrap().id()
    };
    assert_eq!(ids(&played), ids(&still));
    let rest = assets.rig().skeleton.rest_pose();
    for (joint, rest) in still.joints.iter().zip(rest.transforms) {
        let transform = app.world().get::<Transform>(*joint).unwrap();
        assert_eq!(transform.translation, rest.translation);
    }
}

#[test]
fn a_tick_sees_the_pose_of_the_clip_at_the_players_time() {
    for rate in [30.0, 144.0] {
        check_ticks(COLOSSUS.into(), "walk", rate);
    }
    if let Some(fox) = test_data::file("creatures", "models/Fox.glb") {
        check_ticks(fox, "Run", 60.0);
    }
}

#[test]
fn meshes_have_the_tags_and_materials_of_the_file() {
    let mut app = app(60.0);
    let model = clamber_gltf::load(COLOSSUS).unwrap();
    let assets = assets(&mut app, model).unwrap();
    let spawned = spawn(&mut app, &assets, Transform::IDENTITY);
    surfaces(&mut app, &spawned, SkinnedCollider::default());
    let materials = &assets.model().materials;
    let mut kinds = std::collections::BTreeSet::new();
    for mesh in &spawned.meshes {
        let material = app.world().get::<RigMaterial>(*mesh).unwrap().0;
        let surface = app.world().get::<PosedSurface>(*mesh).unwrap();
        let tag = materials[material].tag;
        assert!(surface.mesh().tags().iter().all(|found| *found == tag));
        kinds.insert(tag);
    }
    // Fur, skin, stone, ledges of stone, the shell.
    assert_eq!(kinds.len(), 5);
}

/// The transforms of all joints, and the player, after some frames of 1/64 s.
fn play(player: RigPlayer, frames: usize) -> (Vec<Transform>, RigPlayer) {
    let player_plugin = RigPlayerPlugin::in_schedule(PostUpdate);
    let mut app = app_with(64.0, (ClamberPlugins::default(), player_plugin));
    let assets = assets(&mut app, clamber_gltf::load(COLOSSUS).unwrap()).unwrap();
    let spawned = spawn(&mut app, &assets, Transform::IDENTITY);
    // The first frame has no length.
    app.update();
    app.world_mut().entity_mut(spawned.root).insert(player);
    for _ in 0..frames {
        app.update();
    }
    let world = app.world();
    let transforms = spawned.joints.iter();
    let transforms = transforms.map(|joint| *world.get::<Transform>(*joint).unwrap());
    let player = world.get::<RigPlayer>(spawned.root).unwrap();
    (transforms.collect(), player.clone())
}

#[test]
fn clips_are_held_looped_slowed_and_reversed() {
    let length = clamber_gltf::load(COLOSSUS).unwrap();
    let length = length.rig.clip("walk").unwrap().duration();
    let walk = RigPlayer::new("walk");
    let once = RigPlayer {
        time: length - 0.1,
        looped: false,
        ..walk.clone()
    };
    assert_eq!(play(once.clone(), 32).1.time, length);
    let again = RigPlayer {
        looped: true,
        ..once.clone()
    };
    assert!((play(again, 32).1.time - 0.4).abs() < 1e-9);
    let back = RigPlayer {
        speed: -2.0,
        ..walk.clone()
    };
    assert!((play(back, 32).1.time - (length - 1.0)).abs() < 1e-9);
    let held = RigPlayer {
        speed: 0.0,
        time: 0.5,
        ..walk.clone()
    };
    let (held, _) = play(held, 5);
    let (played, _) = play(walk, 32);
    assert_eq!(held, played);
}

/// A change of clip passes without a jump, and markers are told.
#[test]
fn a_change_of_clip_fades_and_markers_are_told() {
    let mut model = clamber_gltf::load(COLOSSUS).unwrap();
    let step = |time: f64| Marker {
        name: format!("step at {time}"),
        time,
    };
    for clip in &mut model.rig.clips {
        *clip = clip
            .clone()
            .with_markers(vec![step(0.1), step(0.3)])
            .unwrap();
    }
    let player_plugin = RigPlayerPlugin::in_schedule(PostUpdate);
    let mut app = app_with(64.0, (ClamberPlugins::default(), player_plugin));
    #[derive(Resource, Default)]
    struct Heard(Vec<String>);
    app.init_resource::<Heard>().add_observer(
        |passed: On<RigMarkerPassed>, mut heard: ResMut<Heard>| heard.0.push(passed.marker.clone()),
    );
    let assets = assets(&mut app, model).unwrap();
    let spawned = spawn(&mut app, &assets, Transform::IDENTITY);
    app.update();
    let mut entity = app.world_mut().entity_mut(spawned.root);
    entity.insert(RigPlayer::new("walk"));
    let rotations = |app: &App| -> Vec<bevy_math::Quat> {
        let joints = spawned.joints.iter();
        let rotation = |joint: &Entity| app.world().get::<Transform>(*joint).unwrap().rotation;
        joints.map(rotation).collect()
    };
    let frames = |app: &mut App, count: usize| {
        let mut worst = 0f32;
        for _ in 0..count {
            let before = rotations(app);
            app.update();
            let turned = rotations(app).into_iter().zip(before);
            worst = turned
                .map(|(a, b)| a.angle_between(b))
                .fold(worst, f32::max);
        }
        worst
    };
    let walking = frames(&mut app, 20);
    assert_eq!(
        app.world().resource::<Heard>().0,
        ["step at 0.1", "step at 0.3"]
    );
    for (fade, most) in [(0.4, 0.15), (0.0, 9.0)] {
        for clip in ["swipe", "walk"] {
            let player = RigPlayer {
                fade,
                ..RigPlayer::new(clip)
            };
            app.world_mut().entity_mut(spawned.root).insert(player);
            let worst = frames(&mut app, 30);
            assert!(worst < most, "{clip}: {worst} a frame, {walking} before");
            // The control: a cut jumps.
            assert!(fade > 0.0 || worst > 0.2, "{clip}: {worst}");
        }
    }
}

#[test]
fn a_missing_clip_or_a_time_that_is_not_finite_moves_nothing() {
    let (rest, _) = play(RigPlayer::new("no such clip"), 5);
    for (time, speed) in [(f64::NAN, 1.0), (0.0, f64::INFINITY), (f64::MAX, f64::MAX)] {
        let player = RigPlayer {
            time,
            speed,
            ..RigPlayer::new("walk")
        };
        assert_eq!(play(player, 5).0, rest, "{time} {speed}");
    }
}

#[test]
fn a_despawned_joint_ends_the_surface_and_a_despawned_root_leaves_nothing() {
    let mut app = app_with(
        60.0,
        (ClamberPlugins::default(), RigPlayerPlugin::default()),
    );
    let assets = assets(&mut app, clamber_gltf::load(COLOSSUS).unwrap()).unwrap();
    let spawned = spawn(&mut app, &assets, Transform::IDENTITY);
    surfaces(&mut app, &spawned, SkinnedCollider::each_tick());
    let world = app.world_mut();
    world
        .entity_mut(spawned.root)
        .insert(RigPlayer::new("walk"));
    world.entity_mut(spawned.joints[20]).despawn();
    for _ in 0..5 {
        app.update();
    }
    for mesh in &spawned.meshes {
        assert!(app.world().get::<PosedSurface>(*mesh).is_none());
        let status = app.world().get::<ColliderStatus>(*mesh).unwrap();
        assert!(matches!(status, ColliderStatus::Failed(_)), "{status:?}");
    }
    app.world_mut().entity_mut(spawned.root).despawn();
    app.update();
    let left = |joints: Query<&Transform>| joints.iter().count();
    assert_eq!(app.world_mut().run_system_once(left).unwrap(), 0);
}

#[test]
fn more_joints_than_a_mesh_can_index_are_refused() {
    let mut model = clamber_gltf::load(COLOSSUS).unwrap();
    let joint: Joint = model.rig.skeleton.joints()[0].clone();
    let joint = Joint {
        parent: None,
        ..joint
    };
    model.rig.skeleton = Skeleton::new(vec![joint; 65_537]).unwrap();
    let refused = assets(&mut app(60.0), model).err();
    assert_eq!(refused, Some(TooManyJoints(65_537)));
}
