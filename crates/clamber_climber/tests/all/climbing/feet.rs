//! Climbers that stand or hang: hands catch no faster than in flight, a resized body hangs on, one-way platforms have
//! edges to hang from, and a jump turns the climber to the stick.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, StepRules,
};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, Vector};
use clamber_world::{BodyPoses, HalfSpace, Obstacle, RapierTerrain};
use glam::DVec3;

use crate::cases::{WORLDS, pairs};
use crate::input::{HOLD, IDLE, grip_walk};
use crate::moving::MovingHalfSpace;
use crate::numbers::in_world_of_size;
use crate::scene::{FUR, STONE, cuboid_at, list, moved};
use crate::stage::tireless;

/// Plays a climber that stands on a deck and grips fur beside it, which passes it at a speed. Returns the climber, and
/// whether its hands slipped.
fn beside_fur(speed: f64, size: f64, rate: f64, frame: f64) -> (Climber, bool) {
    let config = in_world_of_size(ClimberConfig::colossus_climber(), size);
    let dt = 1.0 / rate;
    let (frame, passes) = (DVec3::X * (frame * size), DVec3::X * (speed * size));
    let mut climber = Climber::new(config, DVec3::Y * (0.4 * size)).unwrap();
    let begins = ClimberState {
        velocity: frame,
        base_velocity: frame,
        heading: DVec3::Z,
        ..*climber.state()
    };
    climber.restore(begins).unwrap();
    let fur = HalfSpace::behind(DVec3::Z * (0.45 * size), DVec3::NEG_Z).unwrap();
    let mut slipped = false;
    for tick in 0..(0.5 * rate) as u32 {
        let moves = |at_rest, velocity: DVec3| MovingHalfSpace {
            at_rest,
            shifts: [tick, tick + 1].map(|tick| velocity * (f64::from(tick) * dt)),
        };
        let deck = moves(HalfSpace::below(0.0), frame);
        let wall = moves(fur.with_tag(FUR), frame + passes);
        let input = if tick > 3 { HOLD } else { IDLE };
        let report = climber.step(&input, &list(&[&deck, &wall]), dt).unwrap();
        let slips = |event: &ClimberEvent| matches!(event, ClimberEvent::HandsSlipped { .. });
        slipped |= report.events.iter().any(slips);
    }
    (climber, slipped)
}

#[test]
fn hands_of_who_stands_catch_no_faster_than_in_flight() {
    for (size, rate) in WORLDS {
        let catches = [(0.0, true), (3.0, true), (10.0, true), (30.0, false)];
        for (frame, (speed, holds)) in pairs([0.0, 30.0, 300.0], catches) {
            let (climber, slipped) = beside_fur(speed, size, rate, frame);
            let told = format!("size {size}, {rate} Hz, {frame} m/s, {speed} m/s past");
            let state = climber.state();
            let mode = if holds {
                ClimberMode::Holding
            } else {
                ClimberMode::Standing
            };
            assert_eq!((state.mode, slipped), (mode, !holds), "{told}");
            // A catch that is faster than a walk costs stamina at once.
            let spent = 1.0 - state.stamina;
            let costs = climber.config().stamina.unwrap().catch_cost;
            let least = costs * (speed * size - climber.config().ground.walk_speed);
            assert!(!holds || spent >= least, "{told}: {spent} of {least}");
        }
    }
}

#[test]
fn who_hangs_and_is_resized_hangs_on() {
    for (size, share) in pairs([0.05, 1.0, 20.0], [0.2, 0.3, 0.5, 0.9, 1.5]) {
        let mut config = tireless();
        // The climber hangs from any surface as steep as a ceiling.
        config.grip.as_mut().unwrap().max_overhang = 1.7;
        let config = config.scaled(size);
        let ceiling = HalfSpace::behind(DVec3::Y * (6.0 * size), DVec3::NEG_Y);
        let ceiling = ceiling.unwrap().with_tag(FUR);
        let around = list(&[&ceiling]);
        let mut climber = Climber::new(config, DVec3::Y * (5.3 * size)).unwrap();
        let hang = |climber: &mut Climber| {
            for _ in 0..120 {
                climber
                    .step(&HOLD, &around, f64::sqrt(size) / 60.0)
                    .unwrap();
            }
            let mode = climber.state().mode;
            assert_eq!(mode, ClimberMode::Hanging, "{size}, to {share}");
        };
        hang(&mut climber);
        climber.try_resize(config.scaled(share), &around).unwrap();
        hang(&mut climber);
    }
}

#[test]
fn who_leaves_a_one_way_platform_with_the_grip_held_hangs_from_its_edge() {
    let one_way = StepRules::by(&|query| query.one_way());
    for (size, rate) in pairs([0.05, 1.0, 20.0], [30.0, 60.0, 240.0]) {
        let half = DVec3::new(2.0, 0.3, 2.0) * size;
        let mut skin = cuboid_at(half.as_vec3(), STONE, DVec3::NEG_Y * half.y);
        let mut world = PhysicsWorld::default();
        let body = world.insert_body(RigidBodyBuilder::fixed());
        let [x, y, z] = half.as_vec3().to_array();
        let collider = ColliderBuilder::cuboid(x, y, z).translation(Vector::new(0.0, -y, 0.0));
        world.insert_collider(collider, Some(body));
        world.detect_collisions(&(), &());
        let before = BodyPoses::new();
        for is_skin in [true, false] {
            let config = ClimberConfig::colossus_climber().scaled(size);
            let at = DVec3::new(1.0, 0.4, 0.0) * size;
            let mut climber = Climber::new(config, at).unwrap();
            let dt = f64::sqrt(size) / rate;
            for _ in 0..(1.5 * rate) as u32 {
                moved(&mut skin, DVec3::NEG_Y * half.y);
                let terrain = RapierTerrain::of_world(&world, &before);
                let platform: &dyn Obstacle = if is_skin { &skin } else { &terrain };
                let input = grip_walk(DVec3::X);
                let around = list(&[platform]);
                climber.step_with(&input, &around, &one_way, dt).unwrap();
            }
            let mode = climber.state().mode;
            let told = format!("size {size}, {rate} Hz, skin {is_skin}");
            assert_eq!(mode, ClimberMode::LedgeHanging, "{told}");
        }
    }
}

/// The jump turns the climber to the stick, as any other tick does in which it walks.
#[test]
fn who_jumps_with_the_stick_faces_its_direction() {
    for size in [1.0, 0.02, 100.0] {
        let config = in_world_of_size(ClimberConfig::walker(), size);
        let floor = HalfSpace::below(0.0);
        let around = list(&[&floor]);
        for (walk, faces) in [
            (DVec3::ZERO, DVec3::Z),
            (DVec3::X * 0.3, DVec3::X),
            (DVec3::new(0.0, 5.0, -1.0), DVec3::NEG_Z),
        ] {
            let mut climber = Climber::new(config, DVec3::Y * (0.4 * size)).unwrap();
            let begins = ClimberState {
                heading: DVec3::Z,
                ..*climber.state()
            };
            climber.restore(begins).unwrap();
            for jump in [false, false, true] {
                let walk = if jump { walk } else { DVec3::ZERO };
                let input = ClimberInput { walk, jump, ..IDLE };
                climber.step(&input, &around, 1.0 / 60.0).unwrap();
            }
            let state = climber.state();
            assert_eq!(state.mode, ClimberMode::Falling, "size {size}, {walk}");
            assert_eq!(state.heading, faces, "size {size}, {walk}");
        }
    }
}
