//! Creatures that live by a brain: what they sense, do and tell in an app.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, AssetServer, Assets, Handle, LoadState};
use bevy_clamber::clamber_colossus::{
    Brain, Creature, CreatureConfig, CreatureKind, Sense, Surroundings,
};
use bevy_clamber::clamber_world::{HalfSpace, Obstacle};
use bevy_clamber::events::ClimberHurt;
use bevy_clamber::prelude::*;
use bevy_clamber::{RigAssets, clamber_gltf};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use glam::DVec3;

const COLOSSUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
const BRAIN: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../assets/colossus.brain.json"
);
const TICK: f64 = 1.0 / 60.0;

/// The giant's own brain, or its body with other states.
fn brain(states: Option<&str>) -> String {
    let text = std::fs::read_to_string(BRAIN).unwrap();
    let Some(states) = states else {
        return text;
    };
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    file["start"] = "start".into();
    file["states"] = serde_json::from_str(states).unwrap();
    file.to_string()
}

/// An app with level ground whose frames are ticks, and which loads assets from a folder.
fn app(folder: &Path, tick: f64) -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin {
            file_path: folder.to_str().unwrap().to_owned(),
            ..AssetPlugin::default()
        },
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        RigPlayerPlugin::default(),
        ColossusPlugin::default(),
    ))
    .init_asset::<Mesh>()
    .init_asset::<SkinnedMeshInverseBindposes>()
    .insert_resource(Time::<Fixed>::from_seconds(tick))
    .insert_resource(TimeUpdateStrategy::ManualDuration(
        Time::<Fixed>::from_seconds(tick).timestep(),
    ));
    app.finish();
    app.cleanup();
    app.world_mut()
        .spawn(CustomObstacle::new(HalfSpace::below(0.0)));
    app
}

/// Spawns the giant with a brain; waits for its surfaces.
fn giant(app: &mut App, brain: Handle<ColossusBrain>, at: Transform) -> SpawnedRig {
    let model = clamber_gltf::load(COLOSSUS).unwrap();
    let assets = app
        .world_mut()
        .resource_scope(|world, mut meshes: Mut<'_, Assets<Mesh>>| {
            let mut poses = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
            RigAssets::new(model, &mut meshes, &mut poses).unwrap()
        });
    let spawned = assets.spawn(&mut app.world_mut().commands(), at);
    app.world_mut().flush();
    for mesh in &spawned.meshes {
        let surface = SkinnedCollider::each_tick();
        app.world_mut().entity_mut(*mesh).insert(surface);
    }
    let is_built = |app: &App, mesh: &Entity| {
        let status = app.world().get::<ColliderStatus>(*mesh).unwrap();
        matches!(status, ColliderStatus::Ready)
    };
    for _ in 0..60_000 {
        app.update();
        if spawned.meshes.iter().all(|mesh| is_built(app, mesh)) {
            let colossus = Colossus {
                seed: 7,
                ..Colossus::new(brain)
            };
            app.world_mut().entity_mut(spawned.root).insert(colossus);
            return spawned;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("the colliders were not built in time");
}

fn add(app: &mut App, text: &str) -> Handle<ColossusBrain> {
    let brain = ColossusBrain::from_json(text).unwrap();
    let mut brains = app.world_mut().resource_mut::<Assets<ColossusBrain>>();
    brains.add(brain)
}

fn body(app: &App, giant: Entity) -> &ColossusBody {
    app.world().get::<ColossusBody>(giant).unwrap()
}

/// Events of a type, gathered by an observer.
#[derive(Resource)]
struct Seen<E>(Vec<E>);

fn watch<E>(app: &mut App)
where
    E: EntityEvent + Clone + Send + Sync + 'static,
{
    app.insert_resource(Seen::<E>(Vec::new()));
    app.add_observer(|event: On<E>, mut seen: ResMut<Seen<E>>| seen.0.push(event.event().clone()));
}

fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("clamber-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// At this size and length of a tick, with Bevy's origin at this place of the world.
fn lives_as_without_an_app(size: f32, tick: f64, origin: DVec3) {
    let mut app = app(&std::env::temp_dir(), tick);
    app.insert_resource(WorldOrigin(origin));
    let text = brain(None);
    let handle = add(&mut app, &text);
    let place = Transform::from_xyz(30.0, 0.0, -12.0)
        .with_rotation(Quat::from_xyzw(0.0, 0.6, 0.0, 0.8))
        .with_scale(Vec3::splat(size));
    let spawned = giant(&mut app, handle, place);

    let rig = clamber_gltf::load(COLOSSUS).unwrap().rig;
    let dt = app.world().resource::<Time<Fixed>>().timestep();
    let made = Brain::from_json(&text, dt.as_secs_f64()).unwrap();
    let kind = Arc::new(CreatureKind::new(&rig, made).unwrap());
    let ahead = (place.rotation * Vec3::Z).as_dvec3();
    let config = CreatureConfig {
        position: origin + place.translation.as_dvec3(),
        scale: f64::from(size),
        yaw: libm::atan2(ahead.x, ahead.z),
        seed: 7,
        ..CreatureConfig::default()
    };
    let mut alone = Creature::new(kind, config).unwrap();
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let mut moved = 0.0f32;
    for tick in 0..1_800 {
        app.update();
        let around = Surroundings {
            terrain: &terrain,
            ..Surroundings::default()
        };
        alone.step(&around).unwrap();
        let found = body(&app, spawned.root).creature();
        assert!(found.state() == alone.state(), "tick {tick}");
        let root = app.world().get::<Transform>(spawned.root).unwrap();
        let at = alone.surface().world_from_model().translation - origin;
        assert_eq!(root.translation, at.as_vec3());
        moved = moved.max(root.translation.distance(place.translation));
        // The skin that climbers touch is in the creature's pose.
        let thigh = alone.kind().skeleton().find("thigh.L").unwrap();
        let joint = app.world().get::<Transform>(spawned.joints[thigh.index()]);
        let local = alone.pose().transforms[thigh.index()];
        assert_eq!(joint.unwrap().translation, local.translation);
        let [found, expected] =
            [joint.unwrap().rotation, local.rotation].map(|turn| turn.as_dquat());
        assert!(found.dot(expected).abs() > 0.999_99);
    }
    assert!(moved > 3.0, "it went {moved} m");
}

#[test]
fn it_lives_as_it_does_without_an_app() {
    lives_as_without_an_app(1.0, TICK, DVec3::ZERO);
    lives_as_without_an_app(0.5, 0.02, DVec3::new(1e5, 0.0, -3e5));
}

#[test]
fn it_notices_a_climber_and_strikes_it() {
    let mut app = app(&std::env::temp_dir(), TICK);
    watch::<ColossusEntered>(&mut app);
    watch::<ColossusStruck>(&mut app);
    watch::<ColossusPlanted>(&mut app);
    watch::<ClimberHurt>(&mut app);
    let handle = add(&mut app, &brain(None));
    let spawned = giant(&mut app, handle, Transform::IDENTITY);
    let hero = app
        .world_mut()
        .spawn((
            Climber::colossus_climber(),
            Transform::from_xyz(0.0, 1.0, 25.0),
        ))
        .id();
    for _ in 0..3_600 {
        app.update();
    }
    let entered = &app.world().resource::<Seen<ColossusEntered>>().0;
    assert!(entered.iter().all(|event| event.entity == spawned.root));
    assert!(entered[0].to.starts_with("alive/alert"), "{:?}", entered[0]);
    let struck = &app.world().resource::<Seen<ColossusStruck>>().0;
    assert!(!struck.is_empty(), "{entered:?}");
    assert_eq!((struck[0].entity, struck[0].climber), (spawned.root, hero));
    assert!(struck[0].attack.starts_with("alive/alert/"), "{struck:?}");
    let hurt = &app.world().resource::<Seen<ClimberHurt>>().0;
    assert!(
        hurt.iter()
            .any(|hurt| hurt.entity == hero && hurt.damage > 0.3)
    );
    let planted = &app.world().resource::<Seen<ColossusPlanted>>().0;
    assert!(planted.len() > 3, "{}", planted.len());
    assert!(planted.iter().all(|foot| foot.place.y.abs() < 3.0));
}

#[test]
fn it_feels_who_rides_it_and_arrows_in_its_weak_points() {
    let mut app = app(&std::env::temp_dir(), TICK);
    watch::<ColossusHurt>(&mut app);
    let text = brain(Some(r#"{ "start": { "act": { "play": "idle" } } }"#));
    let handle = add(&mut app, &text);
    let spawned = giant(&mut app, handle, Transform::IDENTITY);
    app.update();
    let top = {
        let skin = body(&app, spawned.root).creature().surface();
        let from = DVec3::new(0.0, 100.0, -1.0);
        skin.cast_ray(from, -DVec3::Y, 100.0).unwrap().point
    };
    let above = Transform::from_translation(top.as_vec3() + Vec3::Y * 2.0);
    app.world_mut().spawn((Climber::colossus_climber(), above));
    for _ in 0..240 {
        app.update();
    }
    let senses = body(&app, spawned.root).creature().state().senses();
    assert_eq!(senses.get(Sense::Riders), 1.0);
    assert!(senses.get(Sense::RiderSeconds) > 1.0);
    assert!(senses.get(Sense::RiderHeight) > 20.0);
    // An arrow in the first open weak point, and one beside it.
    let open = {
        let creature = body(&app, spawned.root).creature();
        let open = (0..9).find(|point| creature.is_open(*point)).unwrap();
        creature.weak_point(open).unwrap()
    };
    let mut body = app
        .world_mut()
        .get_mut::<ColossusBody>(spawned.root)
        .unwrap();
    assert_eq!(body.strike(DVec3::Y * 500.0, 0.2, 5.0), 0.0);
    assert_eq!(body.strike(open, 0.2, 5.0), 0.2);
    app.update();
    let hurt = &app.world().resource::<Seen<ColossusHurt>>().0;
    assert_eq!(hurt.len(), 1);
    assert!((hurt[0].damage - 0.2).abs() < 1e-12 && !hurt[0].used_up);
}

#[test]
fn a_changed_file_changes_it_while_it_lives() {
    let folder = folder("reload");
    let mut app = app(&folder, TICK);
    let states = |walks: &str, fade: &str| {
        brain(Some(&format!(
            r#"{{ "start": {{ "act": {{ "play": "idle" }}, "fade": {fade}, "transitions": [
                {{ "to": "{walks}", "after": 0.5 }}] }},
                "{walks}": {{ "act": {{ "walk": {{ "to": "patrol", "within": 8 }} }} }} }}"#
        )))
    };
    let file = folder.join("giant.brain.json");
    std::fs::write(&file, states("walks", "0.5")).unwrap();
    let load = |app: &App| {
        app.world()
            .resource::<AssetServer>()
            .load("giant.brain.json")
    };
    let handle: Handle<ColossusBrain> = load(&app);
    let spawned = giant(&mut app, handle.clone(), Transform::IDENTITY);
    let wait = |app: &mut App, until: &dyn Fn(&App) -> bool| {
        for _ in 0..20_000 {
            app.update();
            if until(app) {
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        panic!("nothing happened in time");
    };
    wait(&mut app, &|app| {
        let body = app.world().get::<ColossusBody>(spawned.root);
        body.is_some_and(|body| body.state() == "walks")
    });
    // It turns first, and then walks.
    wait(&mut app, &|app| {
        let creature = body(app, spawned.root).creature();
        creature.state().position().length() > 3.0
    });
    let reload = |app: &App| {
        let server = app.world().resource::<AssetServer>();
        server.reload("giant.brain.json");
    };
    let fade = |app: &App| {
        let brain = body(app, spawned.root).creature().kind().brain().clone();
        brain.fade(brain.find("start").unwrap())
    };
    // The same states with another number: it goes on.
    let ticks = body(&app, spawned.root).creature().state().ticks();
    std::fs::write(&file, states("walks", "1.5")).unwrap();
    reload(&app);
    wait(&mut app, &|app| fade(app) == 1.5);
    assert_eq!(body(&app, spawned.root).state(), "walks");
    assert!(body(&app, spawned.root).creature().state().ticks() > ticks);
    // A file that is wrong changes nothing.
    std::fs::write(&file, states("walks", "-1")).unwrap();
    reload(&app);
    wait(&mut app, &|app| {
        let server = app.world().resource::<AssetServer>();
        matches!(server.load_state(&handle), LoadState::Failed(_))
    });
    assert_eq!(fade(&app), 1.5);
    // Other states: it begins anew where it stands.
    let at = body(&app, spawned.root).creature().state().position();
    assert!(at.length() > 2.0, "{at}");
    std::fs::write(&file, states("strolls", "0.5")).unwrap();
    reload(&app);
    let brain = |app: &App| body(app, spawned.root).creature().kind().brain().clone();
    wait(&mut app, &|app| brain(app).find("strolls").is_some());
    assert_eq!(body(&app, spawned.root).state(), "start");
    let now = body(&app, spawned.root).creature().state().position();
    assert!(now.distance(at) < 5.0, "from {at} to {now}");
    // Ticks of another length: it goes on.
    let ticks = body(&app, spawned.root).creature().state().ticks();
    let mut time = app.world_mut().resource_mut::<Time<Fixed>>();
    time.set_timestep(Duration::from_millis(20));
    wait(&mut app, &|app| brain(app).tick() == 0.02);
    assert!(body(&app, spawned.root).creature().state().ticks() > ticks);
    std::fs::remove_dir_all(folder).unwrap();
}

/// A giant far from the world's origin throws a stone at a climber. An app is told where it bursts, in the app's space:
/// at the climber, which is struck.
#[test]
fn it_throws_stones_that_burst() {
    let mut app = app(&std::env::temp_dir(), TICK);
    let origin = DVec3::new(2e5, 0.0, -1e5);
    app.insert_resource(WorldOrigin(origin));
    watch::<ColossusThrew>(&mut app);
    watch::<ColossusBurst>(&mut app);
    watch::<ColossusWave>(&mut app);
    watch::<ColossusStruck>(&mut app);
    let text = brain(Some(
        r#"{
        "waits": { "transitions": [{ "to": "start", "after": 0.5 }] },
        "start": {
            "act": { "attack": { "clip": "swipe", "limb": ["hand.R"], "follows": 1, "shot": {
                "speed": 22, "radius": 0.7, "damage": 0.1, "throw": 2,
                "wave": { "radius": 9, "speed": 10, "damage": 0.1, "throw": 2 } } } },
            "transitions": [{ "to": "waits" }]
        }
    }"#,
    ));
    let handle = add(&mut app, &text);
    let spawned = giant(&mut app, handle, Transform::from_xyz(30.0, 0.0, 10.0));
    let at = Vec3::new(30.0, 1.0, 35.0);
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    let hero = app.world_mut().spawn(climber).id();
    for _ in 0..900 {
        app.update();
    }
    let threw = &app.world().resource::<Seen<ColossusThrew>>().0;
    let burst = &app.world().resource::<Seen<ColossusBurst>>().0;
    let waves = &app.world().resource::<Seen<ColossusWave>>().0;
    let struck = &app.world().resource::<Seen<ColossusStruck>>().0;
    println!("{threw:?}\n{burst:?}\n{waves:?}\n{struck:?}");
    for (threw, burst) in threw.iter().zip(burst) {
        assert_eq!([threw.entity, burst.entity], [spawned.root; 2]);
        assert_eq!(
            (threw.number, threw.attack.as_str()),
            (burst.number, "start")
        );
        assert!((threw.velocity.length() - 22.0).abs() < 1e-3);
        assert!(threw.place.distance(Vec3::new(30.0, 15.0, 10.0)) < 25.0);
    }
    // It had not seen the climber when it threw the first one.
    let last = burst.len() - 1;
    assert!(burst[last].place.distance(at) < 2.5);
    assert!((waves[last].place - burst[last].place).with_y(0.0).length() < 1e-3);
    assert_eq!(
        (waves[last].entity, waves[last].radius),
        (spawned.root, 9.0)
    );
    assert_eq!(
        (struck[0].climber, struck[0].attack.as_str()),
        (hero, "start")
    );
    let numbers: Vec<u64> = threw.iter().map(|threw| threw.number).collect();
    assert!(
        numbers.len() > 1 && numbers.is_sorted_by(|a, b| a < b),
        "{numbers:?}"
    );
}
