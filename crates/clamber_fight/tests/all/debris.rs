//! Rocks of a physics world that are rolled back together with an arena, for games that need it.

use crate::support::{GIANT, GROUND, Slab};
use clamber_climber::ClimberInput;
use clamber_fight::{Arena, FighterConfig, creature_obstacle};
use clamber_surface::Fingerprint;
use clamber_world::rapier3d::prelude::*;
use clamber_world::{
    BodyPoses, Debris, DebrisConfig, DebrisSnapshot, Obstacle, ObstacleId, RapierTerrain,
};
use glam::{DVec3, Vec3};

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

struct Scene {
    arena: Arena,
    world: PhysicsWorld,
    debris: Debris,
    rocks: Vec<RigidBodyHandle>,
}

impl Scene {
    /// A slab that moves up and down, with a fighter and thirty rocks on it.
    fn new() -> Self {
        let heave = (0..40u8).map(|k| {
            let up = if k % 2 == 0 { 0.0 } else { 0.4 };
            (f32::from(k) * 0.5, Vec3::new(0.0, up, 0.0), Vec3::ONE)
        });
        let slab = Slab {
            keys: heave.collect(),
            ..Slab::default()
        };
        let arena = slab.arena(FighterConfig::hero(), &[DVec3::new(3.0, 1.5, 3.0)]);
        let mut world = PhysicsWorld::default();
        world.insert_collider(
            ColliderBuilder::cuboid(50.0, 1.0, 50.0).translation(Vector::new(0.0, -12.0, 0.0)),
            None,
        );
        let mut debris = Debris::new(DebrisConfig::default());
        let mut rng = fastrand::Rng::with_seed(5);
        let mut lot = || (2.0 * rng.f32() - 1.0) * 4.0;
        let rocks = (0..30).map(|number| {
            let place = Vector::new(lot(), 2.0 + 0.3 * number as f32, lot());
            let rock = world.insert_body(RigidBodyBuilder::dynamic().translation(place));
            world.insert_collider(ColliderBuilder::cuboid(0.3, 0.25, 0.4), Some(rock));
            debris
                .add(rock, &mut world.bodies, &world.colliders)
                .unwrap();
            rock
        });
        let rocks = rocks.collect();
        Self {
            arena,
            world,
            debris,
            rocks,
        }
    }

    /// Steps the arena among the rocks, then the rocks by the same tick. Returns the hash of both.
    fn step(&mut self, tick: u64) -> u64 {
        let poses = BodyPoses::default();
        let input = ClimberInput {
            walk: DVec3::new(0.4, 0.0, if tick % 90 < 45 { 0.5 } else { -0.5 }),
            jump: tick % 50 == 40,
            ..ClimberInput::IDLE
        };
        let rocks = RapierTerrain::of_world(&self.world, &poses);
        let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &rocks)];
        self.arena.step(&[input], &terrain).unwrap();
        let skin = self.arena.creature(GIANT).unwrap().surface();
        let surfaces = [(creature_obstacle(GIANT), skin)];
        let world = &mut self.world;
        self.debris
            .before_step(&surfaces, &mut world.bodies, &mut world.colliders, TICK)
            .unwrap();
        world.step_with_events(&self.debris, &());
        self.debris
            .after_step(
                &surfaces,
                &mut world.bodies,
                &world.colliders,
                &world.broad_phase,
                &world.narrow_phase,
                TICK,
            )
            .unwrap();
        self.hash()
    }

    /// Hash of the arena and of all rocks.
    fn hash(&self) -> u64 {
        let bodies = self.rocks.iter().map(|rock| &self.world.bodies[*rock]);
        let numbers = bodies.flat_map(|body| {
            let (p, q) = (body.translation(), body.rotation());
            let (v, w) = (body.linvel(), body.angvel());
            [
                p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z,
            ]
        });
        let mut hash = Fingerprint::new(self.arena.fingerprint());
        numbers.for_each(|x| hash.floats(&[x]));
        hash.value()
    }
}

#[test]
fn rocks_and_arena_go_back_together_and_on_with_the_same_bits() {
    let mut scene = Scene::new();
    for tick in 0..100 {
        scene.step(tick);
    }
    for from in (100..400).step_by(60) {
        let saved = (
            scene.arena.save(),
            DebrisSnapshot::save(&scene.world, &scene.debris),
        );
        let first: Vec<u64> = (from..from + 60).map(|tick| scene.step(tick)).collect();
        for _ in 0..2 {
            scene.arena.restore(&saved.0).unwrap();
            saved.1.restore(&mut scene.world, &mut scene.debris);
            let again: Vec<u64> = (from..from + 60).map(|tick| scene.step(tick)).collect();
            assert_eq!(first, again, "from {from}");
        }
    }
    // More than ten rocks lie on the slab.
    let lie = scene.rocks.iter();
    let lie = lie.filter(|rock| scene.world.bodies[**rock].translation().y > -2.0);
    assert!(lie.count() > 10);
}

/// The test notices rocks that are not rolled back: with the arena alone, the run differs.
#[test]
fn an_arena_that_goes_back_without_its_rocks_does_not_go_on_the_same() {
    let mut scene = Scene::new();
    for tick in 0..200 {
        scene.step(tick);
    }
    let saved = scene.arena.save();
    let first: Vec<u64> = (200..260).map(|tick| scene.step(tick)).collect();
    scene.arena.restore(&saved).unwrap();
    let again: Vec<u64> = (200..260).map(|tick| scene.step(tick)).collect();
    assert_ne!(first, again);
}
