//! A steady tick of proxies allocates nothing.

use clamber_world::rapier3d::prelude::RigidBodyBuilder;
use glam::DVec3;

use crate::cases::pairs;
use crate::input::walk;
use crate::proxies::scene::{SETTINGS, Scene, WORLD};

/// Memory that proxies allocate in some ticks, with a load on the climber and, if it walks, another one in its way.
fn taken(scene: &mut Scene, direction: DVec3, ticks: u32) -> u64 {
    let mut taken = 0;
    for _ in 0..ticks {
        let dt = scene.dt();
        scene.tick(&walk(direction));
        // Repeats the tick's work on proxies, without anything else in between.
        let world = &mut scene.world;
        let proxy = scene.proxy.as_mut().unwrap();
        let used = allocation_counter::measure(|| {
            let (bodies, colliders) = (&mut world.bodies, &mut world.colliders);
            proxy.after_step(&scene.before, bodies, colliders, &world.narrow_phase, dt);
            proxy.follow(
                &scene.climber.proxy_body(WORLD),
                scene.climber.proxy_touches(WORLD),
                bodies,
                colliders,
                &mut world.impulse_joints,
            );
        });
        taken += used.bytes_total;
    }
    taken
}

#[test]
fn steady_ticks_allocate_nothing() {
    for (setting, direction) in pairs(SETTINGS, [DVec3::ZERO, DVec3::X]) {
        let mut scene = Scene::on_floor(setting);
        let body = || RigidBodyBuilder::dynamic().lock_rotations();
        let load = scene.add(body(), [0.6; 3], DVec3::Y * 1.2, 5.0);
        scene.add(body(), [1.0; 3], DVec3::new(1.0, 0.51, 0.0), 500.0);
        taken(&mut scene, direction, 60);
        let count = taken(&mut scene, direction, 60);
        let above = scene.above(load);
        assert_eq!(count, 0, "{setting:?}, {direction}, {above}");
    }
}
