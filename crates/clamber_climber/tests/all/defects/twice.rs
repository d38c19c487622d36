//! Ground that moves several times per tick of the climber.

use clamber_climber::{Climber, ClimberConfig};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, Vector};
use clamber_world::{BodyPoses, RapierTerrain};
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::events::{count, is_moved_twice};
use crate::input::IDLE;
use crate::scene::{DT, STONE, cuboid, cuboid_at, moved, placed, tick_among};

fn rider() -> Climber {
    let mut config = ClimberConfig::walker();
    config.ground.throw_acceleration = f64::INFINITY;
    Climber::new(config, v(0.0, 0.4, 0.0)).unwrap()
}

#[test]
fn a_surface_advanced_several_times_does_not_carry_its_rider_through_a_wall() {
    let mut floor = cuboid(Vec3::new(30.0, 1.0, 4.0), STONE);
    for thick in [0.1, 0.5] {
        let mut wall = cuboid(Vec3::new(thick as f32 * 0.5, 3.0, 4.0), STONE);
        let speeds = [0.3, 0.7, 3.0, 12.0, 20.0, 28.0, 40.0, 60.0];
        for (per_step, speed, phase) in triples([1u32, 2, 4], speeds, 0..5) {
            let part = speed * DT / f64::from(per_step);
            let far = if speed < 6.0 { 1.0 } else { 6.0 };
            let ahead = far + 0.2 * f64::from(phase) * speed * DT;
            placed(&mut wall, v(ahead, 3.05, 0.0));
            placed(&mut floor, v(0.0, -1.0, 0.0));
            let mut climber = rider();
            let mut x = 0.0;
            let mut twice = 0;
            let ticks = (1.5 * far / (speed * DT)) as u32 + 3;
            for k in 0..ticks {
                for _ in 0..per_step {
                    if k > 3 {
                        x += part;
                    }
                    moved(&mut floor, v(x, -1.0, 0.0));
                }
                moved(&mut wall, v(ahead, 3.05, 0.0));
                let report = tick_among(&mut climber, &[&floor, &wall], &IDLE);
                twice += count(&report.events, is_moved_twice);
                let state = climber.state();
                let told = format!(
                    "{per_step} advances a step, {speed} m/s, wall {thick} m thick at \
                     {ahead}, tick {k} at {}",
                    state.position
                );
                if k > 3 && state.position.x < ahead - 0.5 * thick - 0.45 - speed * DT {
                    let off = (state.velocity - DVec3::X * speed).length();
                    assert!(off < 0.01 * speed, "{told}: {}", state.velocity);
                    let is_told = count(&report.events, is_moved_twice) == 1;
                    assert_eq!(is_told, per_step > 1, "{told}: {:?}", report.events);
                }
                assert!(state.position.x < ahead, "{told}: through the wall");
            }
            let told = format!("{per_step} advances a step, {speed} m/s");
            assert_eq!(twice > 0, per_step > 1, "{told}: {twice}");
        }
    }
}

#[test]
fn a_rapier_world_stepped_twice_does_not_carry_its_rider_through_a_wall() {
    for (per_step, speed) in pairs([1u32, 2], [12.0, 28.0, 40.0]) {
        let mut world = PhysicsWorld::default();
        world.integration_parameters.dt = (DT / f64::from(per_step)) as f32;
        let lorry = RigidBodyBuilder::kinematic_position_based();
        let bed = ColliderBuilder::cuboid(30.0, 1.0, 4.0);
        let (lorry, _) = world.insert(lorry, bed.translation(Vector::new(0.0, -1.0, 0.0)));
        let wall = ColliderBuilder::cuboid(0.05, 3.0, 4.0);
        world.insert_collider(wall.translation(Vector::new(6.5, 3.05, 0.0)), None);
        let mut before = BodyPoses::new();
        world.detect_collisions(&(), &());
        before.record(&world.bodies);
        let mut climber = rider();
        let mut x = 0.0;
        let mut twice = 0;
        for k in 0..(12.0 / (speed * DT)) as u32 {
            for _ in 0..per_step {
                before.record(&world.bodies);
                if k > 3 {
                    x += speed * DT / f64::from(per_step);
                }
                let body = world.bodies.get_mut(lorry).unwrap();
                body.set_next_kinematic_translation(Vector::new(x as f32, 0.0, 0.0));
                world.step();
            }
            let terrain = RapierTerrain::of_world(&world, &before);
            let report = tick_among(&mut climber, &[&terrain], &IDLE);
            twice += count(&report.events, is_moved_twice);
            let state = climber.state();
            let told = format!(
                "{per_step} steps, {speed} m/s, tick {k} at {}",
                state.position
            );
            if k > 3 && state.position.x < 6.0 - speed * DT {
                let off = (state.velocity - DVec3::X * speed).length();
                assert!(off < 0.01 * speed, "{told}: {}", state.velocity);
            }
            assert!(state.position.x < 6.5, "{told}: through the wall");
        }
        assert_eq!(
            twice > 0,
            per_step > 1,
            "{per_step} steps, {speed} m/s: {twice}"
        );
    }
}

/// A swinging surface that is advanced in two halves per tick shakes as much as one that is advanced once.
#[test]
fn a_surface_advanced_twice_does_not_shake_harder() {
    let mut most = [0.0f64; 2];
    for (index, per_step) in [1u32, 2].into_iter().enumerate() {
        let mut floor = cuboid_at(Vec3::new(30.0, 1.0, 4.0), STONE, v(0.0, -1.0, 0.0));
        let mut climber = rider();
        for k in 0..90 {
            for part in 1..=per_step {
                let time = (f64::from(k) + f64::from(part) / f64::from(per_step)) * DT;
                let x = 0.3 * libm::sin(time * 2.0 * core::f64::consts::TAU);
                moved(&mut floor, v(x, -1.0, 0.0));
            }
            tick_among(&mut climber, &[&floor], &IDLE);
            if k >= 30 {
                // The start is left out, since the last velocity is unknown then.
                most[index] = most[index].max(climber.state().shake.length());
            }
        }
    }
    let off = most[1] / most[0] - 1.0;
    assert!(off.abs() < 0.01, "most shake {most:?}");
}
