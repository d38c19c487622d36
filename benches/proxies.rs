//! Measures eight climbers as proxies that crates collide with, in a rapier world of 200 falling crates.
//!
//! Two worlds have the same crates, and take turns. One has the proxies of eight climbers that stand where the crates
//! come down. Its tick records the bodies' poses, steps rapier, evaluates the impact on each climber, stops bodies that
//! entered a climber, and moves the proxies after their climbers. The other has eight kinematic bodies of the same
//! shape; its tick is rapier's step alone.
//!
//! Prints a table and writes it to `target/measure/proxies.csv`: name, value, bound, holds.
//!
//! Run it with `cargo bench -p clamber_benches --bench proxies`; briefly with `-- --test`.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clamber::world::rapier3d::prelude::*;
use clamber::world::{BodyPoses, ClimberProxy, ProxyBody, WorldCapsule};
use clamber_scenes::measure::{Bound, Cells, exit_code, is_brief, quantile};
use glam::DVec3;

/// Number of falling crates, in eight layers of 25.
const CRATES: usize = 200;

/// Number of climbers. The row names say eight.
const CLIMBERS: usize = 8;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let (rounds, ticks) = if brief { (1, 30) } else { (5, 240) };
    let mut times: [Vec<f64>; 3] = Default::default();
    let mut hits = 0;
    for _ in 0..rounds {
        let mut scene = Scene::new();
        let mut plain = crates();
        for place in places() {
            let body = RigidBodyBuilder::kinematic_velocity_based().translation(place.as_vec3());
            plain.insert(body, ColliderBuilder::ball(0.41));
        }
        for _ in 0..ticks {
            let start = Instant::now();
            let since = |start: Instant| start.elapsed().as_secs_f64() * 1e6;
            scene.before.record(&scene.world.bodies);
            scene.world.step();
            let stepped = since(start);
            hits += scene.after_step();
            times[0].push(since(start));
            times[1].push(since(start) - stepped);
            let start = Instant::now();
            plain.step();
            times[2].push(since(start));
        }
    }
    if hits == 0 {
        return Err("no crate struck a climber".into());
    }
    let [whole, own, plain] = times.map(|mut times| quantile(&mut times, 0.5));
    let mut cells = Cells::default();
    cells.value("rapier with eight proxies, us a tick", whole);
    cells.value("of that, after rapier's step", own);
    cells.value("rapier with eight kinematic bodies, us a tick", plain);
    cells.push(
        "proxies / kinematic bodies",
        whole / plain,
        Bound::Most(1.4),
    );
    cells.finish("proxies", brief)
}

/// A world with crates that fall from several heights, spinning, onto the ground.
fn crates() -> PhysicsWorld {
    let mut world = PhysicsWorld::default();
    let ground = ColliderBuilder::cuboid(50.0, 1.0, 50.0).translation(Vector::NEG_Y);
    world.insert_collider(ground, None);
    for index in 0..CRATES {
        let (column, layer) = (index % 25, index / 25);
        let (x, z) = ((column % 5) as f32, (column / 5) as f32);
        let place = Vector::new(
            1.3 * x + 0.02 * layer as f32,
            2.0 + 1.5 * layer as f32,
            1.3 * z,
        );
        let spin = Vector::new(0.5, 0.1 * column as f32, 1.0);
        world.insert(
            RigidBodyBuilder::dynamic().translation(place).angvel(spin),
            ColliderBuilder::cuboid(0.3, 0.3, 0.3).mass(20.0),
        );
    }
    world
}

fn places() -> impl Iterator<Item = DVec3> {
    (0..CLIMBERS).map(|k| DVec3::new(1.3 * (k % 4) as f64, 0.4, 1.3 * (2 * (k / 4)) as f64))
}

/// The world with the proxies.
struct Scene {
    world: PhysicsWorld,
    before: BodyPoses,
    proxies: Vec<(ProxyBody, ClimberProxy)>,
}

impl Scene {
    fn new() -> Self {
        let mut world = crates();
        let proxies = places().map(|place| {
            let body = ProxyBody {
                capsule: WorldCapsule::ball(place, 0.4),
                margin: 0.01,
                mass: 80.0,
                velocity: DVec3::ZERO,
                drift: DVec3::ZERO,
                frame_velocity: DVec3::ZERO,
                up: DVec3::Y,
                support_normal: Some(DVec3::Y),
                gentle: 0.01,
                support: None,
            };
            let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
            (
                body,
                ClimberProxy::insert(&body, DVec3::ZERO, bodies, colliders),
            )
        });
        let proxies = proxies.collect();
        Self {
            world,
            before: BodyPoses::new(),
            proxies,
        }
    }

    /// Runs the proxies' work after rapier's step; returns the number of climbers that were struck.
    fn after_step(&mut self) -> usize {
        let world = &mut self.world;
        let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
        let mut struck = 0;
        for (body, proxy) in &mut self.proxies {
            let hit = proxy.after_step(&self.before, bodies, colliders, &world.narrow_phase, TICK);
            struck += usize::from(hit.is_some());
            proxy.follow(body, [], bodies, colliders, &mut world.impulse_joints);
        }
        struck
    }
}
