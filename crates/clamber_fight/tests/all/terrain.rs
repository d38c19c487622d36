//! The same fight over three implementations of terrain: a half-space, triangles, and a rapier world.

use crate::support::GROUND;
use clamber_climber::{ClimberInput, ClimberMode};
use clamber_fight::actions::BOW;
use clamber_fight::{Arena, ArenaConfig, ArenaError, FighterConfig, ProjectileMotion};
use clamber_world::rapier3d::prelude::*;
use clamber_world::{BodyPoses, HalfSpace, Obstacle, ObstacleId, RapierTerrain, TriangleTerrain};
use glam::{DVec3, Vec3};

/// Horizontal triangles, 200 m wide, in cells of 5 m.
fn triangles() -> TriangleTerrain {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..=40 {
        for column in 0..=40 {
            corners.push(Vec3::new(column as f32 - 20.0, 0.0, row as f32 - 20.0) * 5.0);
            if row < 40 && column < 40 {
                let a = row * 41 + column;
                triangles.extend([[a, a + 41, a + 42], [a, a + 42, a + 1]]);
            }
        }
    }
    TriangleTerrain::new(&corners, &triangles, &[], DVec3::ZERO).unwrap()
}

fn input(tick: u64) -> ClimberInput {
    ClimberInput {
        walk: DVec3::new(0.3, 0.0, -0.5),
        jump: tick == 90,
        actions: if (20..70).contains(&tick) { BOW } else { 0 },
        aim: DVec3::new(1.0, -0.02, 0.2),
        ..ClimberInput::IDLE
    }
}

/// Final position of the fighter, and the tip of its arrow.
fn fought(ground: &dyn Obstacle) -> [DVec3; 2] {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    let hero = arena
        .add_fighter(FighterConfig::hero(), DVec3::new(0.3, 0.9, 0.4))
        .unwrap();
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, ground)];
    let mut saved = None;
    let mut sums = Vec::new();
    for tick in 0..300 {
        arena.step(&[input(tick)], &terrain).unwrap();
        sums.push(arena.fingerprint());
        if tick == 80 {
            saved = Some(arena.to_bytes().unwrap());
        }
    }
    let end = *arena.fighter(hero).unwrap().climber().state();
    assert_eq!(end.mode, ClimberMode::Standing);
    let arrow = arena.projectiles()[0];
    assert!(matches!(arrow.motion, ProjectileMotion::Stuck { .. }));
    let tip = arena.place(&arrow, &terrain).unwrap().tip;
    // The run repeats with the same bits from a saved state, on the same terrain.
    arena.restore_bytes(&saved.unwrap()).unwrap();
    for tick in 81..300 {
        arena.step(&[input(tick)], &terrain).unwrap();
        assert_eq!(arena.fingerprint(), sums[tick as usize]);
    }
    [end.position, tip]
}

#[test]
fn a_fight_is_the_same_over_own_terrain_triangles_and_rapier() {
    let mut world = PhysicsWorld::default();
    let slab = ColliderBuilder::cuboid(100.0, 5.0, 100.0).translation(Vector::new(0.0, -5.0, 0.0));
    world.insert_collider(slab, None);
    world.detect_collisions(&(), &());
    let poses = BodyPoses::default();
    let rapier = RapierTerrain::of_world(&world, &poses);
    let half = fought(&HalfSpace::below(0.0));
    assert!(
        half[0].distance(DVec3::ZERO) > 5.0 && half[1].x > 10.0,
        "{half:?}"
    );
    for (name, other) in [
        ("triangles", fought(&triangles())),
        ("rapier", fought(&rapier)),
    ] {
        for (a, b) in half.iter().zip(other) {
            assert!(a.distance(b) < 1e-2, "{name}: {half:?} {other:?}");
        }
    }
}

/// Ids from 2^62 on belong to the arena.
#[test]
fn terrain_with_an_id_of_the_arena_is_refused_and_changes_nothing() {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    arena.add_fighter(FighterConfig::hero(), DVec3::Y).unwrap();
    let ground = HalfSpace::below(0.0);
    let before = arena.fingerprint();
    for id in [1 << 62, 1 << 63, u64::MAX] {
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(id), &ground)];
        let refused = arena.step(&[ClimberInput::IDLE], &terrain).unwrap_err();
        assert!(matches!(refused, ArenaError::TerrainId { .. }), "{refused}");
        assert_eq!(arena.fingerprint(), before);
    }
}
