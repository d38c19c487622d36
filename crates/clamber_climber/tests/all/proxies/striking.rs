//! Bodies that strike a climber from the side, in the air and on the ground: momentum, and fast small bodies.

use clamber_climber::{ClimberConfig, ClimberMode};
use clamber_world::rapier3d::prelude::{RigidBodyBuilder, Vector};
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::input::IDLE;
use crate::proxies::scene::{SETTINGS, Scene};

#[test]
fn a_body_and_a_floating_climber_share_their_momentum_by_mass() {
    for (setting, mass) in pairs(SETTINGS, [8.0, 80.0, 800.0]) {
        let config = ClimberConfig {
            gravity: DVec3::ZERO,
            ..ClimberConfig::colossus_climber()
        };
        let mut scene = Scene::new(setting, config, DVec3::ZERO);
        scene.world.gravity = Vector::ZERO;
        let body = RigidBodyBuilder::dynamic();
        let load = scene.add(body, [0.6; 3], DVec3::X * -1.5, mass);
        let speed = 2.0 * scene.speed();
        scene.send(load, DVec3::X * speed);
        scene.rest(1.0);
        let (own, other) = (scene.own().x, scene.velocity(load).x);
        let told = format!("{setting:?}, {mass} kg: {own} {other}");
        let together = speed * mass / (mass + 80.0);
        for speed in [own, other] {
            assert!(
                (speed / together - 1.0).abs() < 0.02,
                "{told} of {together}"
            );
        }
        assert!(scene.above(load).x < -0.69, "{told}: {}", scene.above(load));
    }
}

#[test]
fn a_fast_small_body_does_not_pass_through_a_climber() {
    for (setting, speed, above) in triples(SETTINGS, [20.0, 100.0, 400.0], [0.0, 0.2]) {
        let mut scene = Scene::standing(setting);
        let at = scene.beside(DVec3::new(-2.0, above, 0.0));
        let body = RigidBodyBuilder::dynamic().gravity_scale(0.0);
        let stone = scene.add(body, [0.1; 3], at, 0.05);
        let speed = speed * scene.speed();
        scene.send(stone, DVec3::X * speed);
        let mut felt = DVec3::ZERO;
        for tick in 0..scene.ticks(0.5) {
            scene.tick(&IDLE);
            felt += scene.hit.map_or(DVec3::ZERO, |hit| hit.impulse);
            let apart = scene.above(stone);
            let told = format!("{setting:?}, {speed} m/s, {above}, tick {tick}: {apart}");
            assert!(
                (apart.x < 0.1 || above > 0.0) && apart.length() > 0.43,
                "{told}"
            );
            assert_eq!(scene.climber.state().mode, ClimberMode::Standing, "{told}");
        }
        let share = felt.x / (0.05 * speed);
        assert!(
            (if above > 0.0 { -1e-9 } else { 0.9 }..1.02).contains(&share),
            "{setting:?}, {speed}, {above}: {share}"
        );
    }
}

#[test]
fn a_cart_shoves_a_standing_climber() {
    for setting in SETTINGS {
        let mut scene = Scene::standing(setting);
        let at = scene.beside(DVec3::X * -1.5);
        let body = RigidBodyBuilder::dynamic()
            .gravity_scale(0.0)
            .lock_rotations();
        let cart = scene.add(body, [0.6; 3], at, 800.0);
        let speed = 2.0 * scene.speed();
        scene.send(cart, DVec3::X * speed);
        let from = scene.climber.state().position.x;
        for tick in 0..scene.ticks(1.5) {
            scene.tick(&IDLE);
            let told = format!("{setting:?}, tick {tick}: {}", scene.above(cart));
            assert!(scene.above(cart).x < -0.69, "{told}");
            assert!(!scene.climber.state().crushed, "{told}");
        }
        let moved = (scene.climber.state().position.x - from) / setting.0;
        // The climber is pushed along at nearly the cart's speed: the friction of a person hardly slows 800 kg.
        assert!((0.5..2.5).contains(&moved), "{setting:?}: {moved}");
        let left = scene.velocity(cart).x / speed;
        assert!((0.05..0.95).contains(&left), "{setting:?}: {left}");
    }
}
