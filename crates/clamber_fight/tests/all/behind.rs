//! Weapons act from the body, and pass through neither terrain nor another creature.

use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberMode};
use clamber_colossus::CreatureConfig;
use clamber_fight::actions::{BOW, CUT, STAB, THROW};
use clamber_fight::{Arena, ArenaConfig, ArenaEvent, CreatureId, FighterConfig};
use clamber_world::{HalfSpace, Obstacle, ObstacleId, TriangleTerrain};
use glam::{DVec3, Vec3};

use crate::support::{
    GIANT, GROUND, HERO, Slab, Wall, arena_with, giant, hits, level_ground, mode, pressing,
};

type Terrain<'a> = [(ObstacleId, &'a dyn Obstacle)];

/// Id of the floor or the wall.
const WALL: ObstacleId = ObstacleId(1);

/// Corners and triangles of a box.
pub(crate) fn box_of(low: Vec3, high: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners: Vec<Vec3> = (0..8)
        .map(|index| {
            let side = |axis: u32| index >> axis & 1 == 1;
            Vec3::select(glam::BVec3::new(side(0), side(1), side(2)), high, low)
        })
        .collect();
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles: Vec<[u32; 3]> = quads
        .iter()
        .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]])
        .collect();
    (corners, triangles)
}

/// A box of triangles as terrain.
pub(crate) fn block(low: Vec3, high: Vec3) -> TriangleTerrain {
    let (corners, triangles) = box_of(low, high);
    TriangleTerrain::new(&corners, &triangles, &[], DVec3::ZERO).unwrap()
}

fn run(
    arena: &mut Arena,
    input: ClimberInput,
    terrain: &Terrain<'_>,
    ticks: u32,
) -> Vec<ArenaEvent> {
    let mut all = Vec::new();
    for _ in 0..ticks {
        all.extend(arena.step(&[input], terrain).unwrap().to_vec());
    }
    all
}

/// A whole stab: the sword is raised and charged, the button is released, and the next press strikes. Returns the
/// damages.
fn stab(arena: &mut Arena, terrain: &Terrain<'_>) -> Vec<f64> {
    let mut events = run(arena, pressing(STAB), terrain, 200);
    events.extend(run(arena, ClimberInput::IDLE, terrain, 5));
    events.extend(run(arena, pressing(STAB), terrain, 60));
    hits(&events)
}

/// A stab and a plunge onto a floor above the creature do no damage, whether the floor is stone or another creature.
/// Without a floor they do.
#[test]
fn stabs_stop_at_a_floor() {
    let deep = HalfSpace::below(-50.0);
    let floor = block(Vec3::new(-20.0, 0.2, -20.0), Vec3::new(20.0, 0.6, 20.0));
    let slab = Slab::with_heart(9.0);
    for (what, is_stone, is_creature) in [
        ("nothing", false, false),
        ("stone", true, false),
        ("a creature", false, true),
    ] {
        let mut terrain: Vec<(ObstacleId, &dyn Obstacle)> = vec![(GROUND, &deep)];
        if is_stone {
            terrain.push((WALL, &floor));
        }
        let stand = |height: f64| {
            let mut arena = slab.arena(FighterConfig::hero(), &[DVec3::Y * height]);
            if is_creature {
                let above = CreatureConfig {
                    position: DVec3::Y * 0.4,
                    ..CreatureConfig::default()
                };
                arena.add_creature(Slab::default().kind(), above).unwrap();
            }
            arena
        };
        let below = |arena: &Arena| arena.creature(GIANT).unwrap().state().hit_points()[0];
        let mut arena = stand(1.5);
        run(&mut arena, ClimberInput::IDLE, &terrain, 120);
        assert_eq!(mode(&arena), ClimberMode::Standing, "{what}");
        stab(&mut arena, &terrain);
        let hurt = 9.0 - below(&arena);
        assert_eq!(hurt > 0.5, what == "nothing", "{what}: a stab does {hurt}");

        let mut arena = stand(9.0);
        run(&mut arena, ClimberInput::IDLE, &terrain, 3);
        run(&mut arena, pressing(STAB), &terrain, 1);
        run(&mut arena, ClimberInput::IDLE, &terrain, 25);
        run(&mut arena, pressing(STAB), &terrain, 120);
        let hurt = 9.0 - below(&arena);
        assert_eq!(
            hurt > 0.5,
            what == "nothing",
            "{what}: a plunge does {hurt}"
        );
    }
}

/// Cuts, arrows and stones stop at a wall in front of the creature, although the wall is thinner than an arm is long.
#[test]
fn cuts_and_shots_stop_at_a_wall() {
    let ground = HalfSpace::below(-1.6);
    for (what, thick) in [
        ("nothing", None),
        ("a wall", Some(0.1)),
        ("a sheet", Some(0.0)),
    ] {
        let rock = thick.map(|thick: f32| {
            block(
                Vec3::new(-20.0, -5.0, 0.6 - thick),
                Vec3::new(20.0, 20.0, 0.6),
            )
        });
        let mut terrain: Vec<(ObstacleId, &dyn Obstacle)> = vec![(GROUND, &ground)];
        if let Some(rock) = &rock {
            terrain.push((WALL, rock));
        }
        let fight = || {
            let mut arena = arena_with(Wall::of(4).kind());
            let place = DVec3::new(0.0, -1.0, 3.0);
            arena.add_fighter(FighterConfig::hero(), place).unwrap();
            let walk = ClimberInput {
                walk: DVec3::NEG_Z,
                ..ClimberInput::IDLE
            };
            // The fighter walks up to the wall, or into the sword's reach of the creature.
            run(&mut arena, walk, &terrain, 180);
            arena
        };
        let is_free = what == "nothing";
        let mut arena = fight();
        let hurt = hits(&run(&mut arena, pressing(CUT), &terrain, 60));
        assert_eq!(!hurt.is_empty(), is_free, "{what}: a cut hits {hurt:?}");
        for (button, ticks) in [(BOW, 70), (THROW, 2)] {
            let mut arena = fight();
            let aim = ClimberInput {
                aim: DVec3::NEG_Z,
                ..pressing(button)
            };
            let mut events = run(&mut arena, aim, &terrain, ticks);
            let lets_go = ClimberInput { actions: 0, ..aim };
            events.extend(run(&mut arena, lets_go, &terrain, 60));
            let shots = |event: &&ArenaEvent| matches!(event, ArenaEvent::Shot { .. });
            assert_eq!(events.iter().filter(shots).count(), 1, "{what}");
            let hit = events
                .iter()
                .any(|event| matches!(event, ArenaEvent::Hit { .. }));
            assert_eq!(hit, is_free, "{what}: {button}");
        }
    }
}

/// A fighter that stands at the giant's foot, on any side, and shoots at the foot hits its near side.
#[test]
fn shots_at_what_is_near_hit_its_near_side() {
    let terrain = level_ground();
    let kind = giant();
    let mut shot = 0;
    for side in 0..12 {
        let angle = f64::from(side) * core::f64::consts::TAU / 12.0;
        let out = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let mut arena = Arena::new(ArenaConfig::default()).unwrap();
        let config = CreatureConfig {
            sight: 0.0,
            hearing: 0.0,
            ..CreatureConfig::default()
        };
        arena.add_creature(Arc::clone(&kind), config).unwrap();
        let foot = arena.creature(CreatureId(0)).unwrap().sole(0).unwrap();
        let middle = 0.25 * foot.iter().sum::<DVec3>();
        let place = middle + out * 8.0 + DVec3::Y;
        arena.add_fighter(FighterConfig::hero(), place).unwrap();
        let walk = ClimberInput {
            walk: -out,
            aim: -out,
            ..ClimberInput::IDLE
        };
        run(&mut arena, walk, &terrain, 150);
        let aims = ClimberInput {
            walk: DVec3::ZERO,
            actions: BOW,
            ..walk
        };
        if mode(&arena) != ClimberMode::Standing {
            continue;
        }
        run(&mut arena, aims, &terrain, 70);
        let fighter = arena.fighter(HERO).unwrap();
        let center = fighter.climber().state().position;
        let near = arena.creature(CreatureId(0)).unwrap().surface();
        let Some(first) = Obstacle::cast_ray(near, center + DVec3::Y * 0.99, -out, 3.0) else {
            continue;
        };
        let lets_go = ClimberInput { actions: 0, ..aims };
        let events = run(&mut arena, lets_go, &terrain, 30);
        let struck = events.iter().find_map(|event| match event {
            ArenaEvent::Hit { place, .. } => Some(*place),
            _ => None,
        });
        let deep = (struck.unwrap() - first.point).dot(-out);
        println!(
            "side {side}: {:.2} m away, {deep:.2} m behind",
            first.distance
        );
        assert!(deep < 0.3, "side {side}: {deep:.2} m behind the near skin");
        shot += 1;
    }
    assert!(shot >= 4, "{shot} of 12 sides");
}
