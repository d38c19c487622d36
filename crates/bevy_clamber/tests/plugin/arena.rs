//! A fight in an app: its arena is stepped as it is without Bevy, and its entities show it.

use std::sync::{Arc, OnceLock};

use bevy_app::{App, TaskPoolPlugin};
use bevy_asset::{AssetApp, AssetPlugin, Assets};
use bevy_clamber::clamber_body::{Extremity, Figure, Humanoid};
use bevy_clamber::clamber_climber::ClimberInput as Input;
use bevy_clamber::clamber_colossus::{Brain, CreatureConfig, CreatureKind};
use bevy_clamber::clamber_fight::actions::{BOW, STAB};
use bevy_clamber::clamber_fight::{
    Arena, ArenaConfig, ArenaEvent, CreatureId, FighterConfig, FighterId,
};
use bevy_clamber::clamber_gltf;
use bevy_clamber::clamber_world::{HalfSpace, Obstacle, ObstacleId};
use bevy_clamber::prelude::*;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_mesh::skinning::SkinnedMeshInverseBindposes;
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use bevy_transform::components::Transform;
use glam::DVec3;

const TICK: f64 = 1.0 / 60.0;
const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/");

fn asset(name: &str) -> String {
    format!("{ASSETS}{name}")
}

fn kind() -> &'static Arc<CreatureKind> {
    static KIND: OnceLock<Arc<CreatureKind>> = OnceLock::new();
    KIND.get_or_init(|| {
        let rig = clamber_gltf::load(asset("colossus.glb")).unwrap().rig;
        let brain = std::fs::read_to_string(asset("colossus.brain.json")).unwrap();
        let brain = Brain::from_json(&brain, TICK).unwrap();
        Arc::new(CreatureKind::new(&rig, brain).unwrap())
    })
}

/// The giant, with one fighter on its back and one before it.
fn arena() -> Arena {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let config = CreatureConfig::default();
    arena.add_creature(Arc::clone(kind()), config).unwrap();
    for place in [DVec3::new(0.0, 36.0, -1.0), DVec3::new(3.0, 1.0, 25.0)] {
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
    arena
}

/// An app whose frames are ticks, with level ground; the entity of the ground.
fn app(plugin: ArenaPlugin) -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TimePlugin,
        TransformPlugin,
        AssetPlugin::default(),
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberFigurePlugin,
        plugin,
    ))
    .init_asset::<Mesh>()
    .init_asset::<SkinnedMeshInverseBindposes>()
    .insert_resource(Time::<Fixed>::from_seconds(TICK))
    .insert_resource(TimeUpdateStrategy::ManualDuration(
        Time::<Fixed>::from_seconds(TICK).timestep(),
    ));
    app.finish();
    app.cleanup();
    let ground = CustomObstacle::new(HalfSpace::below(0.0));
    let ground = app.world_mut().spawn(ground).id();
    // The first frame has no time.
    app.update();
    app.insert_resource(FightArena::new(arena()));
    (app, ground)
}

fn spawn_rig(app: &mut App, file: &str) -> SpawnedRig {
    let model = clamber_gltf::load(asset(file)).unwrap();
    let assets = app
        .world_mut()
        .resource_scope(|world, mut meshes: Mut<'_, Assets<Mesh>>| {
            let mut poses = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
            RigAssets::new(model, &mut meshes, &mut poses).unwrap()
        });
    let spawned = assets.spawn(&mut app.world_mut().commands(), Transform::IDENTITY);
    app.world_mut().flush();
    spawned
}

/// What the archer does: it draws and shoots, and jumps now and then.
fn archer(tick: u64) -> ClimberInput {
    ClimberInput {
        actions: if tick % 100 < 80 { BOW } else { 0 },
        aim: Vec3::new(-0.1, 0.9, -1.0),
        jump: tick % 70 == 60,
        ..ClimberInput::default()
    }
}

fn rider(tick: u64) -> ClimberInput {
    ClimberInput {
        grip: true,
        actions: if tick % 120 < 90 { STAB } else { 0 },
        ..ClimberInput::default()
    }
}

fn core(input: &ClimberInput) -> Input {
    Input {
        walk: input.walk.as_dvec3(),
        jump: input.jump,
        grip: input.grip,
        actions: input.actions,
        aim: input.aim.as_dvec3(),
        ..Input::IDLE
    }
}

#[test]
fn the_arena_of_an_app_is_bit_for_bit_that_without_bevy() {
    let (mut app, ground_entity) = app(ArenaPlugin::default());
    app.world_mut()
        .entity_mut(ground_entity)
        .insert(TerrainId(7));
    let giant = spawn_rig(&mut app, "colossus.glb");
    let world = app.world_mut();
    world
        .entity_mut(giant.root)
        .insert(ArenaCreature(CreatureId(0)));
    let fighters = [0, 1].map(|id| world.spawn(ArenaFighter(FighterId(id))).id());

    let mut alone = arena();
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(TerrainId(7).obstacle(), &ground)];
    let (mut told, mut most) = (Vec::new(), 0);
    let mut seen = app.world().resource::<Messages<FightEvent>>().get_cursor();
    for tick in 0..600 {
        let inputs = [rider(tick), archer(tick)];
        for (entity, input) in fighters.iter().zip(inputs) {
            *app.world_mut().get_mut::<ClimberInput>(*entity).unwrap() = input;
        }
        app.update();
        let events = alone
            .step(&inputs.map(|input| core(&input)), &terrain)
            .unwrap();
        told.extend(events.to_vec());
        let fight = app.world().resource::<FightArena>();
        assert_eq!(fight.fingerprint(), alone.fingerprint(), "tick {tick}");

        // What is shown is what the arena has.
        let creature = alone
            .creature(CreatureId(0))
            .unwrap()
            .surface()
            .world_from_model();
        let root = app.world().get::<Transform>(giant.root).unwrap();
        assert_eq!(root.translation, creature.translation.as_vec3());
        for (entity, fighter) in fighters.iter().zip(alone.fighters()) {
            let (shown, state) = (
                app.world().get::<Transform>(*entity).unwrap(),
                fighter.climber().state(),
            );
            assert_eq!(shown.translation, state.position.as_vec3());
            let ahead = shown.rotation * Vec3::NEG_Z;
            assert!(
                ahead.distance(state.heading.as_vec3()) < 1e-5,
                "tick {tick}"
            );
        }
        let mut shown: Vec<_> = app
            .world_mut()
            .query::<(&ArenaProjectile, &Transform)>()
            .iter(app.world())
            .map(|(one, place)| (one.0, place.translation))
            .collect();
        shown.sort_by_key(|(id, _)| *id);
        let there: Vec<_> = alone
            .projectiles()
            .iter()
            .filter_map(|one| {
                let place = alone.place(one, &terrain)?;
                Some((one.id, place.tip.as_vec3()))
            })
            .collect();
        assert_eq!(shown, there, "tick {tick}");
        most = most.max(shown.len());
    }
    let messages = app.world().resource::<Messages<FightEvent>>();
    // Messages are kept for two frames.
    let last: Vec<_> = seen.read(messages).map(|event| event.0.clone()).collect();
    assert!(told.ends_with(&last));
    let shots = told
        .iter()
        .filter(|event| matches!(event, ArenaEvent::Shot { .. }));
    assert!(shots.count() >= 5 && most >= 3, "{most}");
    let joints = giant
        .joints
        .iter()
        .zip(&alone.creature(CreatureId(0)).unwrap().pose().transforms);
    for (joint, local) in joints {
        let shown = app.world().get::<Transform>(*joint).unwrap();
        assert_eq!(shown.translation, local.translation);
    }
}

#[test]
fn events_are_told_once_each_to_readers_and_observers() {
    #[derive(Resource, Default)]
    struct Told([Vec<ArenaEvent>; 2]);
    let (mut app, _) = app(ArenaPlugin::default());
    app.init_resource::<Told>();
    app.add_observer(|event: On<FightEvent>, mut told: ResMut<Told>| {
        told.0[0].push(event.event().0.clone());
    });
    app.add_systems(
        bevy_app::PostUpdate,
        |mut read: MessageReader<FightEvent>, mut told: ResMut<Told>| {
            told.0[1].extend(read.read().map(|event| event.0.clone()));
        },
    );
    let mut alone = arena();
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1 << 32), &ground)];
    let mut expected = Vec::new();
    for _ in 0..200 {
        app.update();
        expected.extend(alone.step(&[Input::IDLE; 2], &terrain).unwrap().to_vec());
    }
    let told = app.world().resource::<Told>();
    assert!(expected.len() > 5);
    assert_eq!(told.0[0], expected);
    assert_eq!(told.0[1], expected);
}

#[test]
fn it_is_saved_restored_and_refuses_bad_inputs() {
    let (mut app, _) = app(ArenaPlugin::default());
    let archer_entity = app.world_mut().spawn(ArenaFighter(FighterId(1))).id();
    // Of nobody: it is shown nowhere and steers nobody.
    app.world_mut().spawn(ArenaFighter(FighterId(9)));
    app.world_mut().spawn(ArenaCreature(CreatureId(4)));
    let play = |app: &mut App, from: u64, ticks: u64| {
        for tick in from..from + ticks {
            *app.world_mut()
                .get_mut::<ClimberInput>(archer_entity)
                .unwrap() = archer(tick);
            app.update();
        }
        app.world().resource::<FightArena>().fingerprint()
    };
    play(&mut app, 0, 130);
    let saved = app.world().resource::<FightArena>().to_bytes().unwrap();
    let after = play(&mut app, 130, 100);
    let mut fight = app.world_mut().resource_mut::<FightArena>();
    fight.arena_mut().restore_bytes(&saved).unwrap();
    assert_eq!(play(&mut app, 130, 100), after);

    let tick = app.world().resource::<FightArena>().tick();
    app.world_mut()
        .get_mut::<ClimberInput>(archer_entity)
        .unwrap()
        .aim = Vec3::NAN;
    app.update();
    assert_eq!(app.world().resource::<FightArena>().tick(), tick);
    play(&mut app, 230, 1);
    assert_eq!(app.world().resource::<FightArena>().tick(), tick + 1);

    // Without a fight, nothing is stepped or shown, and arrows go.
    assert!(count_arrows(&mut app) > 0);
    app.world_mut().remove_resource::<FightArena>();
    app.update();
    assert_eq!(count_arrows(&mut app), 0);
}

/// A save of another session: its world is spawned in another order, and after other entities.
#[test]
fn a_save_goes_on_in_a_session_with_other_entities() {
    fn session(others: usize, is_reversed: bool, with_ids: bool) -> App {
        let (mut app, ground) = app(ArenaPlugin::default());
        app.world_mut().despawn(ground);
        for _ in 0..others {
            app.world_mut().spawn_empty();
        }
        let mut planes = [(3, DVec3::Y, 0.0), (1, DVec3::X, -300.0)];
        if is_reversed {
            planes.reverse();
        }
        for (id, normal, offset) in planes {
            let plane = HalfSpace::behind(normal * offset, normal).unwrap();
            let mut plane = app.world_mut().spawn(CustomObstacle::new(plane));
            if with_ids {
                plane.insert(TerrainId(id));
            }
        }
        app
    }
    fn play(app: &mut App, ticks: usize) -> Vec<u64> {
        let fingerprints = (0..ticks).map(|_| {
            app.update();
            app.world().resource::<FightArena>().fingerprint()
        });
        fingerprints.collect()
    }
    for (others, is_reversed, with_ids) in [(0, true, true), (5, true, true), (5, false, false)] {
        let mut first = session(0, false, with_ids);
        play(&mut first, 90);
        let saved = first.world().resource::<FightArena>().to_bytes().unwrap();
        let mut second = session(others, is_reversed, with_ids);
        let mut fight = second.world_mut().resource_mut::<FightArena>();
        fight.arena_mut().restore_bytes(&saved).unwrap();
        let on = fight.fighters()[1].climber().state().support;
        assert!(on.is_some(), "nobody stands on anything");
        let differ = "entities, order and ids";
        assert_eq!(
            play(&mut first, 60),
            play(&mut second, 60),
            "{differ}: {others}, {is_reversed}, {with_ids}"
        );
    }
}

fn count_arrows(app: &mut App) -> usize {
    let world = app.world_mut();
    world.query::<&ArenaProjectile>().iter(world).count()
}

#[test]
fn a_game_that_steps_the_arena_itself_has_its_terrain() {
    fn twice(mut fight: ResMut<'_, FightArena>, terrain: ArenaTerrain<'_, '_>) {
        terrain.with(|terrain| {
            assert_eq!(terrain.len(), 1);
            for _ in 0..2 {
                fight.arena_mut().step(&[Input::IDLE; 2], terrain).unwrap();
            }
        });
    }
    let (mut app, _) = app(ArenaPlugin::default().without_steps());
    app.add_systems(
        bevy_app::FixedPostUpdate,
        twice.before(ClamberSystems::Climb),
    );
    let shown = app.world_mut().spawn(ArenaFighter(FighterId(1))).id();
    for _ in 0..30 {
        app.update();
    }
    let fight = app.world().resource::<FightArena>();
    assert_eq!(fight.tick(), 60);
    let place = fight.fighters()[1].climber().state().position;
    let shown = app.world().get::<Transform>(shown).unwrap();
    assert_eq!(shown.translation, place.as_vec3());
}

/// A fighter with a figure is drawn as a humanoid whose hands are on the giant's skin.
#[test]
fn a_fighters_figure_holds_the_giant_as_it_is_shown() {
    let (mut app, _) = app(ArenaPlugin::default());
    let rig = clamber_gltf::load(asset("hero.glb")).unwrap().rig;
    let humanoid = Humanoid::find(&rig.skeleton).unwrap();
    let figure = Figure::new(rig.skeleton.clone(), humanoid, rig.clips.clone()).unwrap();
    let spawned = spawn_rig(&mut app, "hero.glb");
    let figure = ClimberFigure::new(Arc::new(figure), &spawned).unwrap();
    let hero = app
        .world_mut()
        .spawn((ArenaFighter(FighterId(0)), figure))
        .id();
    let mut worst = 0.0f64;
    let (mut held, mut hands) = (0, 0);
    for _ in 0..400 {
        app.world_mut().get_mut::<ClimberInput>(hero).unwrap().grip = true;
        app.update();
        let fight = app.world().resource::<FightArena>();
        let state = *fight.fighters()[0].climber().state();
        let root = app.world().get::<Transform>(spawned.root).unwrap();
        let away = root.translation.as_dvec3().distance(state.position);
        assert!(away < 2.5, "the figure is {away} m from its climber");
        if !state.mode.is_holding() {
            continue;
        }
        held += 1;
        let skin: &dyn Obstacle = fight.creature(CreatureId(0)).unwrap().surface();
        let figure = app.world().get::<ClimberFigure>(hero).unwrap();
        for hand in Extremity::ALL.into_iter().take(2) {
            let (body, figure) = (figure.body(), figure.figure());
            if body.hold(hand).is_some()
                && let Some(place) = body.touching_point(figure, hand)
            {
                let near = skin.closest_point(place, 1.0).unwrap();
                (worst, hands) = (worst.max(near.distance), hands + 1);
            }
        }
    }
    assert!(held > 200 && hands > 200, "{held} {hands}");
    assert!(worst < 0.02, "{worst}");
}
