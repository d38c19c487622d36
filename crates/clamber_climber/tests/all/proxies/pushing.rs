//! The climber's own effects on bodies are the same with a proxy as without: weight, pushes, landings.

use clamber_climber::{ClimberConfig, ClimberInput, ClimberMode};
use clamber_world::rapier3d::prelude::{RigidBodyBuilder, Vector};
use glam::DVec3;

use crate::cases::triples;
use crate::input::IDLE;
use crate::proxies::scene::{SETTINGS, Scene, Setting};

/// Walks against a box for two seconds, with jumps if wanted. Returns the speed of the box and the climber's place.
fn walked(setting: Setting, mass: f64, jumps: bool, seen: bool) -> (f64, f64) {
    let config = ClimberConfig::walker();
    let mut scene = Scene::new(setting, config, DVec3::Y * 0.41).with_floor();
    if !seen {
        scene = scene.without_proxy();
    }
    let body = RigidBodyBuilder::dynamic()
        .lock_rotations()
        .gravity_scale(0.0);
    let load = scene.add(body, [1.0, 5.0, 1.0], DVec3::new(1.4, 2.5, 0.0), mass);
    for tick in 0..scene.ticks(2.0) {
        let input = ClimberInput {
            walk: DVec3::X,
            jump: jumps && tick % scene.ticks(0.7) == 0,
            ..IDLE
        };
        scene.tick(&input);
    }
    let speed = scene.velocity(load).x / scene.speed();
    (speed, scene.climber.state().position.x / setting.0)
}

#[test]
fn a_walker_pushes_boxes_no_harder_with_a_proxy() {
    for (setting, mass, jumps) in triples(SETTINGS, [20.0, 200.0, 1e4, 1e6], [false, true]) {
        let without = walked(setting, mass, jumps, false);
        let with = walked(setting, mass, jumps, true);
        let told = format!("{setting:?}, {mass} kg, jumps {jumps}: {with:?} {without:?}");
        let slack = 1.02;
        assert!(with.0 <= (without.0 * slack).min(3.01) + 0.01, "{told}");
        assert!(with.0 >= without.0 / slack - 0.01, "{told}");
        if !jumps {
            assert!(
                (with.1 - without.1).abs() < 0.1 + 0.05 * without.1,
                "{told}"
            );
        }
    }
}

#[test]
fn what_carries_the_climber_does_not_collide_with_it() {
    for setting in SETTINGS {
        let run = |seen: bool| {
            let config = ClimberConfig::walker();
            let mut scene = Scene::new(setting, config, DVec3::Y * 0.41);
            if !seen {
                scene = scene.without_proxy();
            }
            let body = RigidBodyBuilder::dynamic()
                .gravity_scale(0.0)
                .lock_rotations();
            let raft = scene.add(body, [9.0, 1.0, 9.0], DVec3::Y * -0.5, 4000.0);
            let mut heights = Vec::new();
            for tick in 0..scene.ticks(2.0) {
                // The raft is thrown up and down with up to 4 m/s².
                let time = f64::from(tick) / f64::from(scene.ticks(1.0));
                let push = libm::sin(time * std::f64::consts::TAU * 2.0) * 4.0 * 4000.0;
                let body = scene.world.bodies.get_mut(raft).unwrap();
                body.reset_forces(true);
                body.add_force(Vector::new(0.0, push as f32, 0.0), true);
                scene.tick(&IDLE);
                let state = scene.climber.state();
                let stands = state.mode == ClimberMode::Standing || tick < scene.ticks(0.2);
                assert!(stands, "{setting:?}, tick {tick}: {:?}", state.mode);
                let raft = f64::from(scene.world.bodies[raft].translation().y);
                heights.push((state.position.y / setting.0, raft / setting.0));
            }
            heights
        };
        let (with, without) = (run(true), run(false));
        for (tick, (a, b)) in with.iter().zip(&without).enumerate() {
            let off = (a.0 - b.0).abs().max((a.1 - b.1).abs());
            assert!(off < 1e-3, "{setting:?}, tick {tick}: {a:?} {b:?}");
        }
    }
}

#[test]
fn the_climber_does_not_touch_its_own_proxy_and_a_removed_one_stops_nothing() {
    let setting = SETTINGS[0];
    let mut scene = Scene::new(setting, ClimberConfig::walker(), DVec3::Y * 0.41).with_floor();
    for _ in 0..60 {
        scene.tick(&IDLE);
        let own = scene.proxy.as_ref().unwrap().collider().into_raw_parts();
        let key = u64::from(own.1) << 32 | u64::from(own.0);
        let touches = |contact: &&clamber_climber::ClimberContact| contact.material.key == key;
        assert_eq!(scene.climber.contacts().iter().filter(touches).count(), 0);
    }
    let (bodies, joints) = (scene.world.bodies.len(), scene.world.impulse_joints.len());
    scene = scene.without_proxy();
    assert_eq!(scene.world.bodies.len(), bodies - 1);
    assert_eq!((joints, scene.world.impulse_joints.len()), (0, 0));
    let load = scene.add(RigidBodyBuilder::dynamic(), [0.6; 3], DVec3::Y * 1.6, 10.0);
    for _ in 0..120 {
        scene.tick(&IDLE);
    }
    assert!(scene.world.bodies[load].translation().y < 0.7);
}
