//! A climber in the air that hits bodies that can be pushed: both go on at one speed.

use clamber_climber::{ClimberConfig, ClimberMode};
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use glam::DVec3;

use crate::cases::WORLDS;
use crate::events::{count, is_hurt};
use crate::input::{IDLE, walk};
use crate::pushing::scene::{MASS, Scene, boxed, cuboid};

/// A body of two walls along X, 3.6 m apart, which moves with a frame.
fn add_walls(scene: &mut Scene, size: f64, mass: f64, frame: DVec3) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic()
        .lock_rotations()
        .can_sleep(false);
    let walls = [1.9, -1.9].map(|x| {
        let place = Vector::new((x * size) as f32, 0.0, 0.0);
        (
            boxed(DVec3::new(0.1, 1.0, 2.0) * size).translation(place),
            mass / 2.0,
        )
    });
    let handle = scene.add(body, walls);
    scene.set_velocity(handle, frame);
    handle
}

#[test]
fn who_flies_against_the_walls_of_its_box_keeps_the_momentum_of_both() {
    for (size, rate, mass, frame) in [
        (1.0, 60.0, 50.0, 0.0),
        (1.0, 30.0, 50.0, 30.0),
        (1.0, 240.0, 50.0, 0.0),
        (0.02, 60.0, 50.0, 0.0),
        (100.0, 60.0, 50.0, 0.0),
        (1.0, 60.0, 1.0, 0.0),
        (1.0, 60.0, 8_000.0, 0.0),
        (1.0, 30.0, 0.8, -30.0),
    ] {
        let config = ClimberConfig {
            gravity: DVec3::ZERO,
            ..ClimberConfig::walker()
        };
        let (frame, speed) = (DVec3::Z * (frame * size), 3.0 * size);
        let mut scene = Scene::with(config, size, 1.0 / rate, 0.0, DVec3::ZERO);
        let walls = add_walls(&mut scene, size, mass, frame);
        scene.throw(DVec3::X * speed, frame);
        let told = format!("size {size}, {rate} Hz, {mass} kg, frame {frame}");
        for tick in 0..(4.0 * rate) as u32 {
            scene.step_and_apply(&IDLE);
            let own = scene.climber.state().velocity.x;
            let sum = scene.momenta(&[walls]).x;
            let told = format!("{told}, tick {tick}: {sum} N s at {own} m/s");
            assert!((sum / (MASS * speed) - 1.0).abs() < 0.01, "{told}");
        }
        let apart = scene.velocity(walls).x - scene.climber.state().velocity.x;
        assert!(apart.abs() < 0.01 * speed, "{told}: {apart} m/s apart");
    }
}

#[test]
fn a_passenger_that_jumps_against_its_carts_walls_does_not_drive_it() {
    for (size, rate) in WORLDS {
        let (config, start) = (ClimberConfig::walker(), DVec3::Y * 0.65);
        let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, start);
        let body = RigidBodyBuilder::dynamic()
            .lock_rotations()
            .enabled_translations(true, false, false)
            .can_sleep(false);
        let wall = |x: f64| {
            let place = Vector::new((x * size) as f32, (2.0 * size) as f32, 0.0);
            (
                boxed(DVec3::new(0.1, 2.0, 2.0) * size).translation(place),
                5.0,
            )
        };
        let deck = (boxed(DVec3::new(2.0, 0.25, 2.0) * size), 40.0);
        let cart = scene.add(body, [deck, wall(1.9), wall(-1.9)]);
        let (mut last, mut most) = (0.0f64, 0.0f64);
        for tick in 0..(6.0 * rate) as u32 {
            let is_ahead = f64::from(tick) / rate % 2.0 < 1.0;
            let mut input = walk(if is_ahead { DVec3::X } else { DVec3::NEG_X });
            input.jump = tick % (rate as u32 / 2) == 3;
            scene.step_and_apply(&input);
            // The reaction to a start on the deck shows a tick later.
            let sum = scene.momenta(&[cart]).x / size;
            most = most.max(sum.abs().min(last));
            last = sum.abs();
        }
        assert!(
            most < 0.02 * MASS * 3.0,
            "size {size}, {rate} Hz: {most} N s"
        );
    }
}

#[test]
fn a_light_ball_from_below_does_not_carry_a_climber_up() {
    for (size, rate, mass, speed) in [
        (1.0, 60.0, 1.0, 20.0),
        (1.0, 30.0, 1.0, 20.0),
        (1.0, 240.0, 1.0, 20.0),
        (0.02, 60.0, 1.0, 20.0),
        (100.0, 60.0, 1.0, 20.0),
        (1.0, 60.0, 0.1, 60.0),
        (1.0, 60.0, 40.0, 10.0),
    ] {
        let (config, start) = (ClimberConfig::walker(), DVec3::Y * 10.0);
        let mut scene = Scene::with(config, size, 1.0 / rate, 9.81, start);
        let body = RigidBodyBuilder::dynamic().translation((DVec3::Y * (8.0 * size)).as_vec3());
        let ball = ColliderBuilder::ball((0.2 * size) as f32).friction(0.0);
        let ball = scene.add(body, [(ball, mass)]);
        scene.set_velocity(ball, DVec3::Y * (speed * size));
        let mut most = 0.0f64;
        for _ in 0..(0.3 * rate) as u32 {
            scene.tick(&IDLE);
            most = most.max(scene.climber.state().velocity.y / size);
        }
        let told = format!("size {size}, {rate} Hz, {mass} kg at {speed} m/s: {most} m/s");
        assert!(most <= mass * speed / (MASS + mass), "{told}");
    }
}

/// A crate against a wall does not give way. The climber stops there in the second tick, and is hurt once.
#[test]
fn a_light_crate_before_a_wall_stops_a_flight_and_hurts_once() {
    for (rate, mass) in [
        (30.0, 1.0),
        (60.0, 1.0),
        (240.0, 1.0),
        (60.0, 20.0),
        (60.0, 0.1),
    ] {
        let config = ClimberConfig {
            health: ClimberConfig::colossus_climber().health,
            gravity: DVec3::ZERO,
            ..ClimberConfig::walker()
        };
        let speed = 13.0;
        let mut scene = Scene::with(config, 1.0, 1.0 / rate, 0.0, DVec3::ZERO);
        let wall = cuboid(0.5, 5.0, 5.0).translation(Vector::new(3.5, 0.0, 0.0));
        scene.world.insert_collider(wall, None);
        let body = RigidBodyBuilder::dynamic()
            .lock_rotations()
            .translation(Vector::new(2.5, 0.0, 0.0));
        scene.add(body, [(cuboid(0.5, 0.5, 0.5), mass)]);
        scene.throw(DVec3::X * speed, DVec3::ZERO);
        let (mut hits, mut hurts) = (0, 0);
        for _ in 0..rate as u32 {
            let report = scene.tick(&IDLE);
            hits += u32::from(scene.climber.state().velocity.x > 0.2 * speed && hits > 0);
            hits += u32::from(!report.pushes.is_empty() && hits == 0);
            hurts += count(&report.events, is_hurt);
        }
        let state = scene.climber.state();
        let told = format!("{rate} Hz, {mass} kg: {hits} {hurts} {state:?}");
        assert_eq!(state.mode, ClimberMode::Falling, "{told}");
        assert!(hits <= 2 && hurts == 1, "{told}");
    }
}
