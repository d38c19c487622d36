//! The frame of a body in the air is not the frame of a support that it left long ago.

use clamber_climber::{
    ClimberError, ClimberInput, ClimberMode, CustomMode, ModeContext, NextMode, StepRules,
};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, Vector};
use clamber_world::{BodyPoses, RapierTerrain};
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::input::IDLE;
use crate::scene::{STONE, cuboid_at, list, moved, throw, walker};

#[test]
fn a_boulder_on_the_ground_stops_a_climber_that_left_a_train() {
    for radius in [3.0f32, 8.0, 20.0] {
        let mut world = PhysicsWorld::default();
        let ground = ColliderBuilder::cuboid(200.0, 0.5, 200.0);
        world.insert_collider(ground.translation(Vector::new(0.0, -0.5, 0.0)), None);
        let boulder = ColliderBuilder::ball(radius).translation(Vector::new(20.0, radius, 0.0));
        world.insert_collider(boulder, None);
        world.step();
        let before = BodyPoses::new();
        let terrain = RapierTerrain::of_world(&world, &before);
        let heights = [0.45, 0.66, 0.9, 1.3];
        for (rate, speed, height) in triples([30.0, 60.0, 240.0], [10.0, 20.0, 35.0], heights) {
            let start = v(10.0, height, 0.0);
            let mut climber = walker(start);
            let velocity = v(speed, 0.0, 0.0);
            throw(&mut climber, velocity, velocity);
            let told = format!("{radius} m, {rate} Hz, {speed} m/s, from {height} m");
            for _ in 0..(2.0 * rate) as u32 {
                let step = climber.step(&IDLE, &list(&[&terrain]), 1.0 / rate);
                step.unwrap();
                let p = climber.state().position;
                let depth = v(20.0, f64::from(radius), 0.0).distance(p);
                assert!(depth > f64::from(radius), "{told}: in the boulder at {p}");
                assert!(p.y > 0.3, "{told}: in the ground at {p}");
            }
        }
    }
}

/// Glides: falls at 2 m/s relative to its frame, as long as a button is held.
struct Glide;

impl CustomMode for Glide {
    fn id(&self) -> u16 {
        1
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let falls = (context.velocity() - context.base_velocity()).dot(context.up()) < -2.0;
        let mode = context.state().mode;
        mode == ClimberMode::Falling && falls && context.input().actions & 1 != 0
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        let (up, base) = (context.up(), context.base_velocity());
        let own = context.velocity() - base;
        context.move_by(base + own - up * (own.dot(up) + 2.0));
        NextMode::Stay
    }
}

#[test]
fn a_glide_after_a_lift_comes_down() {
    let modes: [&dyn CustomMode; 1] = [&Glide];
    for (rate, wind) in pairs([30.0, 60.0, 240.0], [DVec3::ZERO, v(3.0, 1.0, 0.0)]) {
        let rules = StepRules {
            air_velocity: wind,
            ..StepRules::with_modes(&modes)
        };
        let mut lift = cuboid_at(Vec3::new(2.0, 0.5, 2.0), STONE, v(0.0, -0.5, 0.0));
        let mut climber = walker(v(0.0, 0.4, 0.0));
        let mut y = 0.0;
        for tick in 0..(8.0 * rate) as u32 {
            let time = f64::from(tick) / rate;
            if time < 1.0 {
                y += 8.0 / rate;
            }
            moved(&mut lift, v(0.0, y - 0.5, 0.0));
            let input = ClimberInput {
                actions: u32::from(time > 1.0),
                jump: (time - 0.9).abs() < 0.5 / rate,
                ..IDLE
            };
            // Later the lift is gone, and the climber does not come down on it.
            let here = list(&[&lift]);
            let here = if time < 1.5 { &here[..] } else { &[] };
            let step = climber.step_with(&input, here, &rules, 1.0 / rate);
            step.unwrap();
        }
        let told = format!("{rate} Hz, wind {wind}: {:?}", climber.state());
        assert_eq!(climber.state().mode, ClimberMode::Custom(1), "{told}");
        let sinks = climber.state().velocity.y - wind.y;
        assert!((sinks + 2.0).abs() < 1e-9, "{told}");
    }
}

#[test]
fn a_wind_that_is_not_finite_is_refused() {
    let mut climber = walker(DVec3::ZERO);
    let before = *climber.state();
    let rules = StepRules {
        air_velocity: DVec3::NAN,
        ..StepRules::default()
    };
    let refused = climber.step_with(&IDLE, &[], &rules, 1.0 / 60.0);
    assert_eq!(refused.err(), Some(ClimberError::NotFinite("air_velocity")));
    assert_eq!(*climber.state(), before);
}
