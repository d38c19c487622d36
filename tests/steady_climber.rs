//! A climber's steady tick allocates nothing, in any mode and on any obstacle. Only ticks with an event or a push may
//! allocate, for their report.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use std::sync::Arc;

use allocation_counter::measure;
use clamber::climber::{ClimberGroup, GripConfig};
use clamber::prelude::*;
use clamber::world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, Vector};
use clamber_scenes::climbs::{Motion as Walks, RATE, Stage, Ways, long_climber};
use clamber_scenes::giant;
use glam::{DVec3, Vec3};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// The input of a climber that only grips.
const GRIP: ClimberInput = ClimberInput {
    grip: true,
    ..ClimberInput::IDLE
};

/// A rule that uses all data of its query. It allows grip everywhere, and passes every second climber. It only
/// evaluates `one_way`: with its result, the climber would fall through its ground.
fn rule(query: &ContactQuery<'_>) -> ContactRule {
    let asked = (query.one_way(), query.body(), query.path(), query.tag());
    std::hint::black_box(asked);
    let is_passed = query.is_character() && query.id.0.is_multiple_of(2);
    query.usual().with_grip(true).with_solid(!is_passed)
}

/// Counts of the ticks in a mode, with and without events, and the ticks without events that allocated.
#[derive(Debug, Default)]
struct Ticks {
    steady: u32,
    /// Ticks with an event, which may allocate.
    eventful: u32,
    /// The steady ticks that allocated, each with its number of allocations.
    allocating: Vec<(u32, u64)>,
}

impl Ticks {
    /// Makes one tick, and counts it if the climber is in the mode before and after it.
    fn step(
        &mut self,
        climber: &mut Climber,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        mode: ClimberMode,
    ) {
        let was = climber.state().mode;
        let mut report = None;
        let found = measure(|| {
            report = Some(
                climber
                    .step_with(input, obstacles, &StepRules::by(&rule), DT)
                    .unwrap(),
            );
        });
        if was != mode || climber.state().mode != mode {
            return;
        }
        if report.unwrap().events.is_empty() {
            self.steady += 1;
            if found.count_total > 0 {
                self.allocating.push((self.steady, found.count_total));
            }
        } else {
            self.eventful += 1;
        }
    }

    /// Asserts that no steady tick allocated after the first few.
    fn assert_steady(&self, told: &str, least: u32) {
        let late = self.allocating.iter().find(|(tick, _)| *tick > WARM);
        assert_eq!(late, None, "{told}: {self:?}");
        assert!(self.steady > WARM + least, "{told}: {self:?}");
        assert!(self.eventful < self.steady / 5, "{told}: {self:?}");
    }
}

/// Number of steady ticks that may allocate, as a warm-up.
const WARM: u32 = 20;

#[test]
fn climbing_up_and_across_the_walking_giant_allocates_nothing() {
    let creature = giant::giant().unwrap();
    let route = Ways::new(&creature).unwrap().climb(16).unwrap();
    let ways = [
        ("holding", DVec3::ZERO),
        ("up", DVec3::Y),
        ("aside", DVec3::new(0.3, 0.0, 1.0)),
    ];
    for (told, way) in ways {
        let mut stage = Stage::new(&creature, (20.0, 1.0), Walks::Walk).unwrap();
        let (foot, normal) = stage.vertex(route[route.len() / 2]);
        let mut climber = Climber::new(long_climber(), foot + normal * 0.45).unwrap();
        let mut ticks = Ticks::default();
        for tick in 1..=600 {
            stage.advance(f64::from(tick) * DT).unwrap();
            // To one side and the other in turn.
            let side = if tick / 120 % 2 == 0 { 1.0 } else { -1.0 };
            let input = ClimberInput {
                climb: way * side,
                ..GRIP
            };
            let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), stage.surface())];
            ticks.step(&mut climber, &input, &obstacles, ClimberMode::Holding);
        }
        ticks.assert_steady(told, 200);
    }
}

#[test]
fn standing_and_walking_on_the_giant_allocates_nothing() {
    let creature = giant::giant().unwrap();
    for walk in [DVec3::ZERO, DVec3::Z * 0.1] {
        let mut stage = Stage::new(&creature, (20.0, 1.0), Walks::Idle).unwrap();
        let (middle, radius) = stage.surface().bounding_ball().unwrap();
        let top = middle + DVec3::Y * radius;
        let below = stage.surface().cast_ray(top, -DVec3::Y, 2.0 * radius);
        let start = below.unwrap().point + DVec3::Y * 0.45;
        let mut climber = Climber::new(ClimberConfig::walker(), start).unwrap();
        let mut ticks = Ticks::default();
        for tick in 1..=300 {
            stage.advance(f64::from(tick) * DT).unwrap();
            let side = if tick / 30 % 2 == 0 { 1.0 } else { -1.0 };
            let input = ClimberInput {
                walk: walk * side,
                ..ClimberInput::default()
            };
            let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), stage.surface())];
            ticks.step(&mut climber, &input, &obstacles, ClimberMode::Standing);
        }
        ticks.assert_steady(&format!("walking at {walk}"), 200);
    }
}

#[test]
fn hanging_from_the_giant_allocates_nothing() {
    let creature = giant::giant().unwrap();
    let route = Ways::new(&creature).unwrap().climb(16).unwrap();
    let mut stage = Stage::new(&creature, (20.0, 1.0), Walks::Walk).unwrap();
    let (point, normal) = stage.vertex(route[route.len() / 2]);
    let mut config = long_climber();
    // The climber hangs from every hold.
    config.grip = config.grip.map(|grip| GripConfig {
        max_overhang: 0.0,
        ..grip
    });
    let mut climber = Climber::new(config, point + normal * 0.45).unwrap();
    let mut ticks = Ticks::default();
    for tick in 1..=600 {
        stage.advance(f64::from(tick) * DT).unwrap();
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), stage.surface())];
        ticks.step(&mut climber, &GRIP, &obstacles, ClimberMode::Hanging);
    }
    ticks.assert_steady("hanging", 200);
}

/// A closed box on one joint, given by half its sides.
fn block(half: Vec3) -> SkinnedSurface {
    let corner = |k: u32| {
        let side = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
        half * Vec3::new(side(1), side(2), side(4))
    };
    let positions: Vec<Vec3> = (0..8).map(corner).collect();
    let faces: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = faces.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).concat();
    let source = MeshSource::rigid(&positions, &triangles);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

#[test]
fn going_along_a_ledge_that_moves_allocates_nothing() {
    let mut block = block(Vec3::new(4.0, 3.0, 3.0));
    let rest = Palette::from_matrices([Affine::IDENTITY]);
    let place = |tick: u32| {
        // The block moves to one side and up, and back, on parabolas in time.
        let share = f64::from(tick % 150) / 75.0 - 1.0;
        Similarity::from_translation(DVec3::new(1.0, 0.4, 0.0) * (share * share))
    };
    block.teleport(&rest, place(0)).unwrap();
    let mut config = ClimberConfig::colossus_climber();
    // Without grips, the climber only hangs from ledges.
    config.grip = None;
    let mut climber = Climber::new(config, DVec3::new(0.3, 2.75, 3.5)).unwrap();
    let mut ticks = Ticks::default();
    for tick in 1..=400 {
        block.advance(&rest, place(tick)).unwrap();
        let side = if tick / 60 % 2 == 0 { 1.0 } else { -1.0 };
        let walk = if tick < 5 {
            -DVec3::Z * 0.1
        } else {
            DVec3::X * side
        };
        let input = ClimberInput { walk, ..GRIP };
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), &block)];
        ticks.step(&mut climber, &input, &obstacles, ClimberMode::LedgeHanging);
    }
    ticks.assert_steady("along a ledge", 200);
}

#[test]
fn walking_on_rapiers_ground_allocates_nothing() {
    let mut world = PhysicsWorld::default();
    let floor = ColliderBuilder::cuboid(50.0, 0.5, 50.0).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert_collider(floor, None);
    let wall = ColliderBuilder::cuboid(0.5, 1.0, 5.0).translation(Vector::new(4.0, 1.0, 0.0));
    world.insert_collider(wall, None);
    // A body that can be pushed, but is not.
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(-20.0, 0.5, 0.0));
    world.insert(body, ColliderBuilder::cuboid(0.5, 0.5, 0.5));
    let mut before = BodyPoses::new();
    // The body comes to rest.
    (0..120).for_each(|_| world.step());
    let mut climber = Climber::new(ClimberConfig::walker(), DVec3::Y * 0.41).unwrap();
    let mut ticks = Ticks::default();
    for tick in 0..400 {
        before.record(&world.bodies);
        world.step();
        let terrain = RapierTerrain::of_world(&world, &before);
        // The climber walks along the ground, then against the wall.
        let input = ClimberInput {
            walk: DVec3::new(1.0, 0.0, f64::from(tick % 60) / 30.0 - 1.0),
            ..ClimberInput::default()
        };
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &terrain)];
        ticks.step(&mut climber, &input, &obstacles, ClimberMode::Standing);
    }
    ticks.assert_steady("walking on rapier's ground", 300);
    assert!(climber.state().position.x > 2.5, "{:?}", climber.state());
}

/// A walk among other climbers: the rule lets the climber pass through some of them, others block it.
#[test]
fn walking_among_friends_allocates_nothing() {
    let ground = block(Vec3::splat(30.0));
    let at = |x: f64, z: f64| {
        let place = DVec3::new(x, 30.4, z);
        Climber::new(ClimberConfig::walker(), place).unwrap()
    };
    let friends: Vec<(ObstacleId, Climber)> = (0..6)
        .map(|index| {
            (
                ObstacleId(10 + index),
                at(index as f64, f64::from(index as u32 % 2) * 0.5),
            )
        })
        .collect();
    let fixed: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), &ground)];
    let mut group = ClimberGroup::default();
    let mut climber = at(-2.0, 0.2);
    let mut ticks = Ticks::default();
    for tick in 0..400 {
        let others = friends.iter().map(|(id, friend)| (*id, friend));
        group.update(others, &fixed, DT);
        let obstacles: Vec<_> = fixed
            .into_iter()
            .chain(group.others(ObstacleId(2)))
            .collect();
        let side = if tick / 120 % 2 == 0 { 1.0 } else { -1.0 };
        let input = ClimberInput {
            walk: DVec3::X * side,
            ..ClimberInput::default()
        };
        ticks.step(&mut climber, &input, &obstacles, ClimberMode::Standing);
    }
    ticks.assert_steady("walking among friends", 200);
}

#[test]
fn the_counter_sees_a_first_tick() {
    let ground = block(Vec3::splat(3.0));
    let mut climber = Climber::new(ClimberConfig::walker(), DVec3::Y * 4.0).unwrap();
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
    let found = measure(|| drop(climber.step(&ClimberInput::default(), &obstacles, DT)));
    assert!(found.count_total > 0, "{found:?}");
}
