//! Records arenas with several creatures and climbers and replays them, from cut files, too.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use clamber_climber::{ClimberInput, Knockback, StepRules};
use clamber_colossus::{Brain, CreatureConfig, CreatureKind};
use clamber_fight::{
    Arena, ArenaConfig, ArenaError, ArenaPart, CreatureId, FighterConfig, FighterId, Order,
};
use clamber_record::{
    ArenaInfo, ArenaRecorder, ArenaRecording, Ending, RecordError, RecordOptions, Recording,
};
use clamber_scenes::duel::Duel;
use clamber_scenes::giant;
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use foxglove::Decode;
use foxglove::messages::{Log, PointCloud, SceneUpdate};
use glam::{DVec3, Vec3};

use crate::elsewhere::rock;
use crate::python::run_python;
use crate::stage::{GROUND, terrain};

/// Length of the recordings, ticks: five seconds, for several chunks.
const TICKS: u64 = 300;

fn kind() -> &'static Arc<CreatureKind> {
    static KIND: OnceLock<Arc<CreatureKind>> = OnceLock::new();
    KIND.get_or_init(|| Duel::kind().unwrap())
}

/// Two giants and three fighters: one on each giant, and one in front of the second.
fn arena() -> Arena {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    for x in [0.0, 40.0] {
        let config = CreatureConfig {
            position: DVec3::X * x,
            ..CreatureConfig::default()
        };
        arena.add_creature(Arc::clone(kind()), config).unwrap();
    }
    for place in [
        DVec3::new(0.0, 36.0, -1.0),
        DVec3::new(43.0, 1.0, 25.0),
        DVec3::new(40.0, 36.0, -1.0),
    ] {
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
    }
    arena
}

fn inputs(tick: u64) -> Vec<ClimberInput> {
    let player = |player: u64| Duel::input(player as usize % 2, tick + 30 * player).to_input();
    (0..3).map(player).collect()
}

fn step(arena: &mut Arena, inputs: &[ClimberInput], orders: &[Order]) -> Result<(), ArenaError> {
    let terrain = terrain();
    let rules = StepRules::default();
    arena.step_with(inputs, orders, &terrain, &rules).map(drop)
}

fn file() -> &'static [u8] {
    static FILE: OnceLock<Vec<u8>> = OnceLock::new();
    FILE.get_or_init(|| {
        let mut arena = arena();
        let mut info = ArenaInfo::of(&arena);
        info.creatures = vec!["grey".to_owned(), "brown".to_owned()];
        info.fighters[1] = "archer".to_owned();
        info.settings = [("seed".to_owned(), "1".to_owned())].into();
        let options = RecordOptions::waiting();
        let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
        recorder.name(GROUND, "ground");
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let points = corners.map(|(x, z)| Vec3::new(x, 0.0, z) * 50.0);
        let terrain = terrain();
        for tick in 0..TICKS {
            recorder.scenery(&rock("ground", &points)).unwrap();
            let inputs = inputs(tick);
            arena.step(&inputs, &terrain).unwrap();
            recorder.tick(&arena, &inputs, &[], &terrain).unwrap();
        }
        recorder.finish().unwrap()
    })
}

#[test]
fn a_recording_replays_from_its_beginning_and_from_every_second() {
    let recording = ArenaRecording::from_bytes(file().to_vec()).unwrap();
    assert_eq!(*recording.ending(), Ending::Whole);
    assert_eq!(
        (recording.first(), recording.last()),
        (Some(0), Some(TICKS))
    );
    assert_eq!(recording.info().creatures, ["grey", "brown"]);
    assert_eq!(
        recording.info().fighters,
        ["fighter 0", "archer", "fighter 2"]
    );
    let ticks = recording.ticks().map(Result::unwrap);
    let numbers = ticks.map(|tick| {
        assert_eq!(recording.tick(tick.tick).unwrap(), tick);
        tick.tick
    });
    assert!(numbers.eq(0..=TICKS));
    let beyond = recording.tick(TICKS + 1);
    assert!(matches!(beyond, Err(RecordError::NoTick { .. })));
    let mut arena = arena();
    for from in [None, Some(59), Some(60), Some(61), Some(200), Some(TICKS)] {
        let replay = recording.replay(&mut arena, from, step).unwrap();
        assert_eq!(replay.difference, None, "{from:?}");
        let start = from.map_or(0, |from| from / 60 * 60);
        assert_eq!((replay.from, replay.agreed), (start, TICKS - start + 1));
    }
}

#[test]
fn a_difference_names_who_is_different() {
    let recording = ArenaRecording::from_bytes(file().to_vec()).unwrap();
    let mut arena = arena();
    // The archer has another input in one tick.
    let replay = recording
        .replay(&mut arena, None, |arena, inputs, orders| {
            let mut inputs = inputs.to_vec();
            if arena.tick() == 120 {
                inputs[1].aim.x += 1e-9;
                inputs[1].actions ^= clamber_fight::actions::BOW;
            }
            step(arena, &inputs, orders)
        })
        .unwrap();
    let difference = replay.difference.unwrap();
    assert_eq!((difference.recorded.tick, replay.agreed), (121, 121));
    let archer = (ArenaPart::Fighter(FighterId(1)), "archer".to_owned());
    assert_eq!(difference.parts.first(), Some(&archer), "{difference}");
    assert!(difference.to_string().contains("not the same archer"));

    // The ground is a nanometre lower.
    let replay = recording
        .replay(&mut arena, None, |arena, inputs, _| {
            let ground = HalfSpace::below(-1e-9);
            let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
            arena.step(inputs, &terrain).map(drop)
        })
        .unwrap();
    assert!(replay.difference.is_some());
}

#[test]
fn other_arenas_orders_and_recordings_are_refused() {
    let recording = ArenaRecording::from_bytes(file().to_vec()).unwrap();
    let mut other = Arena::new(ArenaConfig {
        stuck_arrows: 7,
        ..ArenaConfig::default()
    })
    .unwrap();
    other.add_kind(Arc::clone(kind())).unwrap();
    let before = other.fingerprint();
    let refused = recording.replay(&mut other, None, step).unwrap_err();
    assert!(
        matches!(refused, RecordError::OtherArena { .. }),
        "{refused}"
    );
    assert_eq!(other.fingerprint(), before);
    // This arena does not know the giant's kind.
    let mut other = Arena::new(ArenaConfig::default()).unwrap();
    let refused = recording.replay(&mut other, None, step).unwrap_err();
    let unknown = ArenaError::Kind {
        kind: clamber_fight::KindId(kind().fingerprint()),
    };
    assert_eq!(refused.to_string(), unknown.to_string());
    let beyond = recording.replay(&mut arena(), Some(TICKS + 1), step);
    assert!(matches!(beyond, Err(RecordError::NoTick { .. })));

    let said = Recording::from_bytes(file().to_vec())
        .unwrap_err()
        .to_string();
    assert!(said.contains("ArenaRecording"), "{said}");

    let mut arena = arena();
    let info = ArenaInfo::of(&arena);
    let options = RecordOptions::waiting();
    assert!(ArenaRecorder::new(Vec::new(), &info, &other, options).is_err());
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    let idle = [ClimberInput::IDLE; 3];
    // The arena was not stepped.
    let again = recorder.tick(&arena, &idle, &[], &[]).unwrap_err();
    assert!(matches!(again, RecordError::Order { .. }), "{again}");
    step(&mut arena, &idle, &[]).unwrap();
    let none = recorder.tick(&arena, &[], &[], &[]).unwrap_err();
    assert!(matches!(none, RecordError::Inputs { .. }), "{none}");
    step(&mut arena, &idle, &[]).unwrap();
    let twice = recorder.tick(&arena, &idle, &[], &[]).unwrap_err();
    assert!(matches!(twice, RecordError::Order { .. }), "{twice}");
}

/// A file that is cut or changed anywhere is read up to its last whole chunk, and replays.
#[test]
fn files_that_were_cut_or_changed_give_what_is_whole() {
    let whole = file();
    let mut rng = fastrand::Rng::with_seed(3);
    let (mut read, mut most) = (0, 0);
    for round in 0..400 {
        let mut bytes = whole.to_vec();
        if round % 2 == 0 {
            bytes.truncate(rng.usize(..whole.len()));
        } else {
            bytes[rng.usize(..whole.len())] ^= 1 << rng.u8(..8);
        }
        let Ok(recording) = ArenaRecording::from_bytes(bytes) else {
            continue;
        };
        let Some(last) = recording.last() else {
            continue;
        };
        (read, most) = (read + 1, most.max(last));
        for tick in recording.ticks_from(0) {
            tick.unwrap();
        }
        if round % 40 == 0 {
            let from = Some(last.saturating_sub(10));
            let replay = recording.replay(&mut arena(), from, step).unwrap();
            assert_eq!(replay.difference, None);
        }
    }
    assert!(read > 200 && most > 200, "{read} {most}");
}

/// The log has the names of creatures, joints, fighters and terrain, and each creature has its views.
#[test]
fn the_views_name_and_hold_everybody() {
    let mut counts: BTreeMap<String, u64> = BTreeMap::new();
    let mut lines = Vec::new();
    for message in mcap::MessageStream::new(file()).unwrap() {
        let message = message.unwrap();
        let topic = &message.channel.topic;
        *counts.entry(topic.clone()).or_default() += 1;
        if topic == "/log" {
            let log = Log::decode(&message.data[..]).unwrap();
            lines.push(format!("{}: {}", log.name, log.message));
        }
    }
    let views = TICKS / 4 + 1;
    for topic in ["/skin/0", "/skin/1", "/brain/0", "/brain/1", "/scene"] {
        assert_eq!(counts[topic], views, "{topic}");
    }
    assert_eq!(counts["/arena"], TICKS + 1);
    assert_eq!(counts["/arena_snapshot"], TICKS / 60 + 1);
    assert_eq!(counts["/scenery"], 1);
    let has = |start: &str| lines.iter().any(|line| line.starts_with(start));
    println!("{}", lines.join("\n"));
    assert!(
        has("fighter 0: grabbed grey (chest)") && has("fighter 2: hit brown (chest) with a stab")
    );
    assert!(has("archer: landed on ground at ") && has("archer: shot projectile 0"));
}

#[test]
fn the_python_reader_reads_a_cut_file_to_its_last_chunk() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cut.mcap");
    for share in [0.3, 0.55, 0.9] {
        let cut = &file()[..(file().len() as f64 * share) as usize];
        std::fs::write(&path, cut).unwrap();
        let ours = ArenaRecording::from_bytes(cut.to_vec()).unwrap();
        let Some(last) = run_python("cut.py", &path) else {
            return;
        };
        assert_eq!(last.trim().parse().ok(), ours.last(), "{share}: {last}");
    }
}

/// Names that are too few, too many, shared or reserved are refused before anything is written.
#[test]
fn names_are_one_each() {
    let arena = arena();
    type Change = fn(&mut ArenaInfo);
    let wrong: [(Change, &str); 6] = [
        (|info| info.fighters[0] = "world".into(), "`world`"),
        (
            |info| info.creatures[0] = "projectiles".into(),
            "`projectiles`",
        ),
        (|info| info.creatures.truncate(1), "1 names for 2 creatures"),
        (
            |info| info.fighters.push("ann".into()),
            "4 names for 3 fighters",
        ),
        (
            |info| info.creatures[1] = "creature 0".into(),
            "`creature 0`",
        ),
        (
            |info| info.fighters[2] = "creature 1".into(),
            "`creature 1`",
        ),
    ];
    for (change, words) in wrong {
        let mut info = ArenaInfo::of(&arena);
        change(&mut info);
        let options = RecordOptions::waiting();
        let recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options);
        let error = recorder.map(|_| ()).unwrap_err();
        assert!(matches!(error, RecordError::Names(_)), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    // A fighter that joins later has a name that no other has.
    let mut info = ArenaInfo::of(&arena);
    info.fighters[0] = "fighter 3".into();
    assert_eq!(info.fighter(3), "fighter 3 (joined)");
    assert_eq!(info.fighter(4), "fighter 4");
}

/// The game's orders in the step to a tick.
fn orders(tick: u64, arena: &Arena) -> Vec<Order> {
    let (fighter, creature) = (FighterId(1), CreatureId(0));
    let kind = clamber_fight::KindId(kind().fingerprint());
    match tick {
        20 => vec![Order::Send {
            creature,
            to: Some(DVec3::new(-0.0, 0.0, 90.0)),
        }],
        40 => vec![
            Order::Strike {
                fighter,
                knockback: Knockback {
                    velocity: DVec3::new(3.0, 9.0, -0.0),
                    damage: 0.25,
                    by: None,
                },
            },
            Order::AddFighter {
                config: Box::new(FighterConfig::hero()),
                position: DVec3::new(-5.0, 1.0, 20.0),
            },
        ],
        70 => vec![
            Order::RemoveFighter {
                fighter: FighterId(0),
            },
            Order::AddCreature {
                kind,
                config: CreatureConfig {
                    position: DVec3::X * 150.0,
                    scale: 0.3,
                    ..CreatureConfig::default()
                },
            },
        ],
        // This fighter has left before.
        90 => vec![Order::Hurt {
            fighter: FighterId(0),
            damage: 0.5,
        }],
        130 => vec![Order::RemoveCreature {
            creature: CreatureId(1),
        }],
        200 => vec![
            Order::Heal {
                fighter,
                hit_points: 1.0,
                stamina: 0.1,
            },
            Order::RemoveCreature {
                creature: arena.creatures().last().unwrap().0,
            },
        ],
        _ => Vec::new(),
    }
}

/// Orders are recorded, and replayed from any tick by an arena that knows only the kind of the creatures. Creatures and
/// fighters that join and leave are logged, and a creature that joins has channels of its own.
#[test]
fn orders_are_recorded_and_played_again() {
    let mut arena = arena();
    let info = ArenaInfo::of(&arena);
    let options = RecordOptions::waiting();
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    for tick in 1..=TICKS {
        let orders = orders(tick, &arena);
        let fighters = arena.fighters().iter();
        let inputs: Vec<ClimberInput> = fighters
            .map(|fighter| inputs(tick)[fighter.id().0 as usize % 3])
            .collect();
        step(&mut arena, &inputs, &orders).unwrap();
        recorder.tick(&arena, &inputs, &orders, &[]).unwrap();
    }
    let file = recorder.finish().unwrap();
    let recording = ArenaRecording::from_bytes(file.clone()).unwrap();
    assert_eq!(*recording.ending(), Ending::Whole);
    for from in [None, Some(61), Some(100), Some(200), Some(TICKS)] {
        let mut fresh = Arena::new(ArenaConfig::default()).unwrap();
        fresh.add_kind(Arc::clone(kind())).unwrap();
        let replay = recording.replay(&mut fresh, from, step).unwrap();
        assert_eq!(replay.difference, None, "{from:?}");
        assert_eq!(fresh.fingerprint(), arena.fingerprint());
    }
    // Without the orders, a replay differs from the tick of the first order on.
    let replay = recording.replay(&mut arena, None, |arena, inputs, _| {
        step(arena, inputs, &[])
    });
    let difference = replay.unwrap().difference.unwrap();
    assert_eq!(difference.recorded.tick, 20);
    let part = (ArenaPart::Creature(CreatureId(0)), "creature 0".to_owned());
    assert_eq!(difference.parts.first(), Some(&part));
    // The replay has one fighter more than was recorded.
    let replay = recording.replay(&mut arena, None, |arena, inputs, orders| {
        let mut orders = orders.to_vec();
        if arena.tick() == 9 {
            orders.push(Order::AddFighter {
                config: Box::new(FighterConfig::hero()),
                position: DVec3::X * 900.0,
            });
        }
        step(arena, inputs, &orders)
    });
    let difference = replay.unwrap().difference.unwrap();
    assert_eq!(difference.recorded.tick, 10);
    let part = (ArenaPart::Fighter(FighterId(3)), "fighter 3".to_owned());
    assert_eq!(difference.parts.first(), Some(&part));

    // Creatures and fighters that left are not drawn any more.
    let all = mcap::MessageStream::new(&file).unwrap();
    let (mut points, mut deleted) = (BTreeMap::new(), Vec::new());
    for message in all.map(Result::unwrap) {
        let topic = &message.channel.topic;
        if topic.starts_with("/skin/") {
            let cloud = PointCloud::decode(&message.data[..]).unwrap();
            points.insert(topic.clone(), (cloud.data.len(), cloud.frame_id));
        } else if topic == "/scene" {
            let scene = SceneUpdate::decode(&message.data[..]).unwrap();
            deleted.extend(scene.deletions.into_iter().map(|deletion| deletion.id));
        }
    }
    for (creature, is_here) in [(0, true), (1, false), (2, false)] {
        let (bytes, frame) = &points[&format!("/skin/{creature}")];
        assert_eq!(*bytes > 0, is_here, "creature {creature}");
        assert!(frame.contains(&creature.to_string()), "{frame}");
    }
    assert_eq!(deleted, [info.fighter(0)]);

    let bytes = String::from_utf8_lossy(&file);
    for words in [
        "/brain/2",
        "joined",
        "left",
        "somebody who is not there",
        "Strike",
    ] {
        assert!(bytes.contains(words), "{words}");
    }
}

/// An arena with very high numbers, as in a forged or very old state, takes no more memory to record than another one.
#[test]
fn numbers_that_are_far_on_cost_nothing() {
    let mut arena = arena();
    let mut state = arena.save();
    (state.next_creature, state.next_fighter) = (1 << 31, 1 << 31);
    arena.restore(&state).unwrap();
    let info = ArenaInfo::of(&arena);
    assert_eq!(info.creatures.len(), 1000);
    let options = RecordOptions::waiting();
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    let inputs = inputs(1);
    step(&mut arena, &inputs, &[]).unwrap();
    recorder.tick(&arena, &inputs, &[], &[]).unwrap();
    assert!(recorder.finish().unwrap().len() < 1 << 20);
}

/// A giant's shots, waves and beams are drawn where they are, as long as they exist.
#[test]
fn what_attacks_have_let_out_is_drawn() {
    let mut file: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(giant::brain_path()).unwrap()).unwrap();
    file["start"] = "throws".into();
    file["states"] = serde_json::json!({
        "throws": {
            "act": { "attack": { "clip": "swipe", "limb": ["hand.R"], "shot": {
                "speed": 22, "radius": 0.7, "damage": 0.1, "throw": 2,
                "wave": { "radius": 9, "speed": 10, "damage": 0.1, "throw": 2 } } } },
            "transitions": [{ "to": "shines" }]
        },
        "shines": {
            "act": { "attack": { "clip": "swipe", "limb": ["hand.R"],
                "beam": { "length": 80, "radius": 0.4, "damage": 0.1, "throw": 2 } } },
            "transitions": [{ "to": "throws" }]
        }
    });
    let brain = Brain::from_json(&file.to_string(), 1.0 / 60.0).unwrap();
    let kind = CreatureKind::new(&giant::model().unwrap().rig, brain).unwrap();
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let config = CreatureConfig {
        position: DVec3::X * 12.0,
        ..CreatureConfig::default()
    };
    arena.add_creature(Arc::new(kind), config).unwrap();
    let place = DVec3::new(0.0, 1.0, 30.0);
    arena.add_fighter(FighterConfig::hero(), place).unwrap();
    let options = RecordOptions::waiting();
    let info = ArenaInfo::of(&arena);
    let mut recorder = ArenaRecorder::new(Vec::new(), &info, &arena, options).unwrap();
    let terrain = terrain();
    let inputs = [ClimberInput::IDLE];
    // Balls (shots and waves): place and radius. Beams: start and length.
    let drawn = |arena: &Arena| {
        let giant = arena.creature(CreatureId(0)).unwrap();
        let shots = giant.shots().map(|shot| (shot.place, shot.radius));
        let waves = giant.waves().map(|wave| (wave.place, wave.reach));
        let beam = giant.report().beam;
        let beams = beam.map(|beam| (beam.from, beam.from.distance(beam.to)));
        (shots.chain(waves).collect(), Vec::from_iter(beams))
    };
    let mut expected: Vec<[Vec<(DVec3, f64)>; 2]> = vec![[Vec::new(), Vec::new()]];
    for tick in 1..=1200 {
        arena.step(&inputs, &terrain).unwrap();
        recorder.tick(&arena, &inputs, &[], &terrain).unwrap();
        if tick % 4 == 0 {
            let (balls, beams) = drawn(&arena);
            expected.push([balls, beams]);
        }
    }
    let file = recorder.finish().unwrap();
    let all = mcap::MessageStream::new(&file).unwrap().map(Result::unwrap);
    let scenes = all.filter(|message| message.channel.topic == "/scene");
    let mut counts = [0; 2];
    for (index, message) in scenes.enumerate() {
        let scene = SceneUpdate::decode(&message.data[..]).unwrap();
        let attacks = scene
            .entities
            .iter()
            .find(|entity| entity.id == "attacks")
            .unwrap();
        let place = |pose: &Option<foxglove::messages::Pose>| {
            let at = pose.as_ref().unwrap().position.as_ref().unwrap();
            DVec3::new(at.x, at.y, at.z)
        };
        let spheres = attacks.spheres.iter();
        let balls: Vec<(DVec3, f64)> = spheres
            .map(|ball| (place(&ball.pose), 0.5 * ball.size.as_ref().unwrap().y))
            .collect();
        let arrows = attacks.arrows.iter();
        let beams: Vec<(DVec3, f64)> = arrows
            .map(|beam| (place(&beam.pose), beam.shaft_length + beam.head_length))
            .collect();
        for (kind, (ours, theirs)) in [&balls, &beams]
            .into_iter()
            .zip(&expected[index])
            .enumerate()
        {
            counts[kind] += ours.len();
            assert_eq!(ours.len(), theirs.len(), "view {index}");
            for (a, b) in ours.iter().zip(theirs) {
                let off = a.0.distance(b.0).max((a.1 - b.1).abs());
                assert!(off < 1e-6, "view {index}: {a:?} {b:?}");
            }
        }
        assert_eq!(index + 1 == expected.len(), index == 300);
    }
    println!("{counts:?}");
    assert!(counts[0] > 30 && counts[1] > 10, "{counts:?}");
}
