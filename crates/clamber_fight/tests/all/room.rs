//! Fighters that join, respawn or are moved find room.

use crate::support::{GROUND, giant, kill, level_ground, rest, rises};
use clamber_climber::{ClimberInput, StepRules};
use clamber_colossus::CreatureConfig;
use clamber_fight::{Arena, ArenaConfig, ArenaEvent, CreatureId, FighterConfig, FighterId, Order};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, Pose};
use clamber_world::{BodyPoses, HalfSpace, Obstacle, ObstacleId, RapierTerrain, WorldCapsule};
use glam::DVec3;

fn arena() -> Arena {
    Arena::new(ArenaConfig::default()).unwrap()
}

fn died(events: &[ArenaEvent]) -> usize {
    let died = |event: &&ArenaEvent| matches!(event, ArenaEvent::Died { .. });
    events.iter().filter(died).count()
}

/// The least distance of a body's axis from an obstacle that it overlaps; infinite if it overlaps none.
fn distance(obstacle: &dyn Obstacle, body: &WorldCapsule) -> f64 {
    let mut contacts = Vec::new();
    obstacle.overlap_capsule(body, &mut contacts);
    let distances = contacts.iter().map(|contact| contact.distance);
    distances.fold(f64::INFINITY, f64::min)
}

/// Fighters with the same spawn point stand apart from the first ticks on, and none of them is crushed to death.
#[test]
fn fighters_with_one_spawn_point_stand_apart() {
    let terrain = level_ground();
    for count in [2usize, 3, 8, 100] {
        for apart in [0.0, 1e-9, 0.01, 0.1] {
            let mut arena = arena();
            for index in 0..count {
                let place = DVec3::new(apart * index as f64 / count as f64, 1.0, 0.0);
                arena.add_fighter(FighterConfig::hero(), place).unwrap();
            }
            // Each fighter walks in its own direction.
            let input = |index: usize| {
                let angle = index as f64 / count as f64 * core::f64::consts::TAU;
                let walk = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
                ClimberInput {
                    walk,
                    ..ClimberInput::IDLE
                }
            };
            let inputs: Vec<ClimberInput> = (0..count).map(input).collect();
            let still = vec![ClimberInput::IDLE; count];
            let mut dead = 0;
            for tick in 0..240 {
                let inputs = if tick < 30 { &still } else { &inputs };
                dead += died(arena.step(inputs, &terrain).unwrap());
                if tick == 20 {
                    let places: Vec<DVec3> = (arena.fighters().iter())
                        .map(|fighter| fighter.climber().state().position)
                        .collect();
                    for (index, a) in places.iter().enumerate() {
                        for b in &places[..index] {
                            let level = (*a - *b).with_y(0.0).length();
                            assert!(level > 0.4, "{count}, {apart}: {level} m apart");
                        }
                    }
                }
            }
            assert_eq!(dead, 0, "{count} fighters, {apart} m");
        }
    }
}

/// A fighter that joins or respawns inside the giant is put beside it.
#[test]
fn nobody_rises_inside_a_creature() {
    let terrain = level_ground();
    let kind = giant();
    for (joint, scale) in [
        ("foot.L", 1.0),
        ("shin.L", 1.0),
        ("pelvis", 1.0),
        ("chest", 1.0),
        ("chest", 7.0),
        ("foot.L", 7.0),
    ] {
        for dies in [false, true] {
            let mut arena = arena();
            let config = CreatureConfig {
                scale,
                ..CreatureConfig::default()
            };
            arena.add_creature(kind.clone(), config).unwrap();
            let frame = arena.creature(CreatureId(0)).unwrap().palette();
            let frame = frame.model_from_joint(kind.skeleton().find(joint).unwrap());
            let spawn = frame.unwrap().translation * scale;
            let mut config = FighterConfig::hero();
            config.respawn = Some(0.5);
            arena.add_fighter(config, spawn).unwrap();
            let mut looked = 0;
            for tick in 0..160 {
                if tick == 60 && dies {
                    kill(&mut arena);
                }
                let events = arena.step(&[ClimberInput::IDLE], &terrain).unwrap();
                if tick != 0 && !rises(events) {
                    continue;
                }
                looked += 1;
                let body = arena.fighter(FighterId(0)).unwrap().climber().body();
                let middle = 0.5 * (body.ends[0] + body.ends[1]);
                // Most rays that begin inside a skin leave it through its back.
                let skin = arena.creature(CreatureId(0)).unwrap().surface();
                let leaves = |index: &u32| {
                    let angle = f64::from(*index) * 0.7;
                    let way =
                        DVec3::new(libm::cos(angle), libm::sin(1.3 * angle), libm::sin(angle));
                    let hit = Obstacle::cast_ray(skin, middle, way, 1e4);
                    hit.is_some_and(|hit| hit.normal.dot(way) > 0.0)
                };
                let inside = (0..20).filter(leaves).count();
                assert!(
                    inside < 10,
                    "{joint}, tick {tick}: at {middle}, {inside} of 20"
                );
                let near = distance(skin, &body);
                assert!(near > 0.7 * body.radius, "{joint}, tick {tick}: {near} m");
            }
            assert_eq!(
                looked,
                1 + usize::from(dies),
                "{joint}, {scale} times as large"
            );
        }
    }
}

/// A dead fighter without room waits until there is some.
#[test]
fn who_finds_no_room_waits() {
    let mut config = FighterConfig::hero();
    config.respawn = Some(0.5);
    let mut arena = arena();
    arena.add_fighter(config, DVec3::Y).unwrap();
    let ground = HalfSpace::below(0.0);
    // Rock up to 30 m above the ground.
    let rock = HalfSpace::below(30.0);
    let open: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let full: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &rock)];
    rest(&mut arena, &open, 20);
    kill(&mut arena);
    for tick in 0..300 {
        let events = arena.step(&[ClimberInput::IDLE], &full).unwrap();
        assert!(!rises(events), "tick {tick}");
    }
    let mut rose = None;
    for tick in 0..60 {
        let events = arena.step(&[ClimberInput::IDLE], &open).unwrap();
        if rises(events) {
            rose.get_or_insert(tick);
        }
    }
    assert!(rose.is_some_and(|tick| tick <= 31), "{rose:?}");
}

/// A fighter that is revived, moved or added where there is rock by now is put beside the rock.
#[test]
fn nobody_is_put_into_rock() {
    let ground = HalfSpace::below(0.0);
    let mut world = PhysicsWorld::default();
    let pose = Pose::translation(0.0, 3.0, 0.0);
    world.insert_collider(ColliderBuilder::cuboid(4.0, 3.0, 4.0).position(pose), None);
    world.detect_collisions(&(), &());
    let poses = BodyPoses::default();
    let rock = RapierTerrain::of_world(&world, &poses);
    let open: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &ground)];
    let full: [(ObstacleId, &dyn Obstacle); 2] = [(GROUND, &ground), (ObstacleId(9), &rock)];
    let rules = StepRules::default();
    let there = DVec3::new(0.3, 0.9, 0.2);
    let config = Box::new(FighterConfig::hero());
    let fighter = FighterId(0);
    for what in ["rises", "is put", "joins"] {
        let mut arena = arena();
        arena.add_fighter(*config, there).unwrap();
        rest(&mut arena, &open, 20);
        let order = match what {
            "rises" => {
                kill(&mut arena);
                arena.step(&[ClimberInput::IDLE], &open).unwrap();
                Order::Rise { fighter }
            }
            "is put" => Order::PlaceFighter {
                fighter,
                position: there,
            },
            _ => {
                // The first fighter leaves, so that its place is free.
                let leaves = Order::RemoveFighter { fighter };
                let idle = [ClimberInput::IDLE];
                arena.step_with(&idle, &[leaves], &open, &rules).unwrap();
                Order::AddFighter {
                    config: config.clone(),
                    position: there,
                }
            }
        };
        let idle = vec![ClimberInput::IDLE; arena.fighters().len()];
        arena.step_with(&idle, &[order], &full, &rules).unwrap();
        for _ in 0..30 {
            let at = arena.fighters()[0].climber().state().position;
            let out = at.x.abs().max(at.z.abs()) - 4.0;
            assert!(out > 0.2, "{what}: at {at}");
            arena.step(&[ClimberInput::IDLE], &full).unwrap();
        }
        assert!(arena.fighters()[0].climber().state().hit_points > 0.9);
    }
}

/// A fighter that joins or is moved deep into a creature of several kilometres finds no room. It looks again until
/// there is some.
#[test]
fn who_is_put_where_no_room_is_looks_again() {
    let terrain = level_ground();
    let rules = StepRules::default();
    let kind = giant();
    let config = CreatureConfig {
        scale: 100.0,
        ..CreatureConfig::default()
    };
    let chest = kind.skeleton().find("chest").unwrap();
    for joins in [true, false] {
        for waits in [1, 29, 100] {
            let mut arena = arena();
            arena.add_creature(kind.clone(), config).unwrap();
            let frame = arena.creature(CreatureId(0)).unwrap().palette();
            let position = frame.model_from_joint(chest).unwrap().translation * 100.0;
            let hero = FighterConfig::hero();
            let (order, idle) = if joins {
                let config = Box::new(hero);
                (Order::AddFighter { config, position }, Vec::new())
            } else {
                let place = DVec3::new(9000.0, 1.0, 0.0);
                let fighter = arena.add_fighter(hero, place).unwrap();
                let put = Order::PlaceFighter { fighter, position };
                (put, vec![ClimberInput::IDLE])
            };
            rest(&mut arena, &terrain, 40);
            let has_begun = |arena: &Arena| {
                let state = serde_json::to_value(arena.save()).unwrap();
                let begun = state.pointer("/fighters/0/state/has_begun").unwrap();
                begun.as_bool().unwrap()
            };
            arena.step_with(&idle, &[order], &terrain, &rules).unwrap();
            let idle = [ClimberInput::IDLE];
            for _ in 0..waits {
                arena.step(&idle, &terrain).unwrap();
                assert!(!has_begun(&arena));
            }
            // A waiting fighter that is moved elsewhere looks for room at once.
            let mut other = Arena::new(ArenaConfig::default()).unwrap();
            other.add_creature(kind.clone(), config).unwrap();
            other.restore_bytes(&arena.to_bytes().unwrap()).unwrap();
            let put = Order::PlaceFighter {
                fighter: other.fighters()[0].id(),
                position: DVec3::new(9000.0, 1.0, 0.0),
            };
            other.step_with(&idle, &[put], &terrain, &rules).unwrap();
            assert!(has_begun(&other), "joins: {joins}, {waits} ticks");
            let away = Order::PlaceCreature {
                creature: CreatureId(0),
                position: DVec3::new(1e5, 0.0, 0.0),
                yaw: 0.0,
            };
            arena.step_with(&idle, &[away], &terrain, &rules).unwrap();
            rest(&mut arena, &terrain, 31);
            assert!(has_begun(&arena), "joins: {joins}, {waits} ticks");
        }
    }
}

/// A fighter that stands where a creature is put is outside of it in the same tick, and is not struck there before.
#[test]
fn creatures_that_are_put_on_people_make_room() {
    let terrain = level_ground();
    let rules = StepRules::default();
    let kind = giant();
    let offsets = [-1.5, -0.8, 0.0, 0.8, 1.5];
    let all = offsets
        .iter()
        .flat_map(|x| offsets.map(|z| DVec3::new(*x, 0.0, z)));
    let cases = [0.5, 1.0, 7.0].map(|scale| all.clone().map(move |off| (scale, off * scale)));
    for (scale, off) in cases.into_iter().flatten() {
        let foot = {
            let mut arena = arena();
            let config = CreatureConfig {
                scale,
                ..CreatureConfig::default()
            };
            arena.add_creature(kind.clone(), config).unwrap();
            let foot = arena.creature(CreatureId(0)).unwrap().sole(0).unwrap();
            0.25 * foot.iter().sum::<DVec3>()
        };
        let mut arena = arena();
        let config = CreatureConfig {
            scale,
            position: DVec3::new(900.0, 0.0, 0.0),
            ..CreatureConfig::default()
        };
        arena.add_creature(kind.clone(), config).unwrap();
        let mut hero = FighterConfig::hero();
        hero.crush = None;
        arena.add_fighter(hero, DVec3::Y).unwrap();
        let idle = [ClimberInput::IDLE];
        rest(&mut arena, &terrain, 40);
        let put = Order::PlaceCreature {
            creature: CreatureId(0),
            position: off - foot.with_y(0.0),
            yaw: 0.0,
        };
        let events = arena.step_with(&idle, &[put], &terrain, &rules).unwrap();
        let is_struck = |event: &ArenaEvent| matches!(event, ArenaEvent::Struck { .. });
        assert!(!events.iter().any(is_struck), "{scale} {off}");
        let skin = arena.creature(CreatureId(0)).unwrap().surface();
        let body = arena.fighters()[0].climber().body();
        let middle = 0.5 * (body.ends[0] + body.ends[1]);
        assert!(
            !skin.in_world().is_inside(middle),
            "{scale} {off}: {middle}"
        );
        let near = distance(skin, &body);
        assert!(near > 0.7 * body.radius, "{scale} {off}: {near} m");
    }
}
