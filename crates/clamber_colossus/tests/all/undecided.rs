//! A brain, or a game, that changes its mind in each tick.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use core::f64::consts::{PI, TAU};

use clamber_animation::rig::Palette;
use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, Foresight, Surroundings};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, Pose};
use clamber_world::{BodyPoses, HalfSpace, Obstacle, RapierTerrain};
use glam::{DVec3, Vec3};

use crate::support::{TICK, brain_with, creature, ground, kind, person};

const STATES: &str = r#"{
    "stands": { "fade": 0.8 },
    "swipes": { "act": { "play": "swipe" } },
    "kicks": { "act": { "play": "kick_left" } },
    "shakes": { "act": { "play": "shake" } },
    "turns": { "act": { "turn": { "to": "prey", "within_deg": 15 } } },
    "walks": { "act": { "walk": { "to": "patrol", "within": 1 } } },
    "idles": { "act": { "play": "idle" }, "fade": 0.3 }
}"#;

/// How far its skin reaches up, and how wide it is, metres.
fn size(one: &Creature) -> [f64; 2] {
    let mut skin: Vec<Vec3> = Vec::new();
    one.surface().clone().skin_all(&mut skin);
    let most = |of: fn(&Vec3) -> f32| f64::from(skin.iter().map(of).fold(0.0, f32::max));
    let scale = one.surface().world_from_model().scale;
    [
        scale * most(|place| place.y),
        scale * most(|place| place.with_y(0.0).length()),
    ]
}

/// Fades that begin anew in each tick do not let its limbs fly away, wherever it was in its clips when that began, and
/// its feet stay on the ground.
#[test]
fn who_changes_states_in_each_tick_keeps_its_shape() {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let people = [person(DVec3::new(-30.0, 0.0, -10.0))];
    let around = Surroundings {
        terrain: &terrain,
        people: &people,
        ..Surroundings::default()
    };
    let kind = kind(&brain_with("stands", STATES));
    for before in ["swipes", "kicks", "shakes"] {
        for between in [["stands", "turns"], ["idles", "walks"], ["stands", "idles"]] {
            for seconds in [0.4, 0.9, 1.7] {
                let mut one = creature(&kind, CreatureConfig::default());
                let [height, _] = size(&one);
                assert!(one.enter(before));
                for _ in 0..(seconds / TICK) as u32 {
                    one.step(&around).unwrap();
                }
                let [_, width] = size(&one);
                let mut most = [0.0f64; 3];
                for tick in 0..300 {
                    assert!(one.enter(between[tick % 2]));
                    one.step(&around).unwrap();
                    let [high, wide] = size(&one);
                    most[0] = most[0].max(high / height);
                    most[1] = most[1].max(wide / width.max(0.5 * height));
                    if tick < 120 {
                        continue;
                    }
                    for leg in 0..2 {
                        let clearance = one.foot_clearance(leg, &terrain).unwrap();
                        let share = clearance / one.kind().foot_length(leg);
                        if one.state().is_planted(leg) && one.state().speed() == 0.0 {
                            most[2] = most[2].max(share.abs());
                        }
                    }
                }
                println!("{before} for {seconds} s, then {between:?}: {most:.3?}");
                assert!(
                    most[0] < 1.04 && most[1] < 1.1,
                    "{before} {between:?}: {most:?}"
                );
                assert!(most[2] < 0.005, "{before} {between:?}: {most:?}");
            }
        }
    }
}

fn heading(one: &Creature) -> DVec3 {
    let yaw = one.state().yaw();
    DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw))
}

/// A pen of rock around the origin, in which the giant cannot turn.
pub(crate) fn pen() -> PhysicsWorld {
    let mut world = ground(|_, _| 0.0);
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let at = DVec3::new(x, 0.0, z) * 19.0 + DVec3::Y * 8.0;
        let wall = ColliderBuilder::cuboid(10.0, 8.0, 10.0);
        world.insert_collider(wall.position(Pose::from_translation(at.as_vec3())), None);
    }
    world.detect_collisions(&(), &());
    world
}

/// How many states it enters in 20 s.
fn entered(one: &mut Creature, around: &Surroundings<'_>) -> usize {
    let mut entered = 0;
    for _ in 0..1200 {
        let report = one.step(around).unwrap();
        let is_entered = |event: &&CreatureEvent| matches!(event, CreatureEvent::Entered { .. });
        entered += report.events.iter().filter(is_entered).count();
    }
    println!("entered {entered} states in 20 s");
    entered
}

/// Where it cannot turn to its prey, it tries for a while before its brain hears of it; and it is not foreseen to turn.
#[test]
fn who_cannot_turn_tries_for_a_while() {
    let poses = BodyPoses::default();
    let world = pen();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let people = [person(DVec3::new(-60.0, 0.0, 6.0))];
    let around = Surroundings {
        terrain: &terrain,
        people: &people,
        ..Surroundings::default()
    };
    for end in ["done", "blocked"] {
        let states = r#"{
            "hunt": { "transitions": [
                { "to": "face", "any": ["prey_bearing_deg > 70", "prey_bearing_deg < -70"] }
            ] },
            "face": { "act": { "turn": { "to": "prey", "within_deg": 15 } }, "transitions": [
                { "to": "hunt", "when": ["END"] }
            ] }
        }"#;
        let kind = kind(&brain_with("hunt", &states.replace("END", end)));
        let mut one = creature(&kind, CreatureConfig::default());
        let entered = entered(&mut one, &around);
        assert!((10..=42).contains(&entered), "{end}: {entered}");
        assert!(one.state().yaw().abs() < 0.2, "it turned");
        for _ in 0..40 {
            one.step(&around).unwrap();
            let mut palette = Palette::default();
            let then = one.foresee(2.0, &mut Foresight::default(), &mut palette);
            let ahead = then.unwrap().rotation * DVec3::Z;
            let now = heading(&one);
            let turned = libm::atan2(ahead.cross(now).length(), ahead.dot(now));
            assert!(turned < 0.05, "foreseen to turn by {turned}");
        }
    }
}

/// An attack that is not begun since rock is in its way, in a brain without a pause.
#[test]
fn who_cannot_strike_tries_for_a_while() {
    let states = r#"{
        "hunt": { "transitions": [{ "to": "stomp", "when": ["prey_distance < 100"] }] },
        "stomp": { "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"], "damage": 0.6, "throw": 9 } },
            "transitions": [{ "to": "hunt" }] }
    }"#;
    let kind = kind(&brain_with("hunt", states));
    let mut world = ground(|_, _| 0.0);
    let wall = ColliderBuilder::cuboid(40.0, 6.0, 2.0);
    world.insert_collider(
        wall.position(Pose::from_translation(Vec3::new(0.0, 6.0, 8.0))),
        None,
    );
    world.detect_collisions(&(), &());
    let poses = BodyPoses::default();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let people = [person(DVec3::new(0.0, 0.0, 40.0))];
    let around = Surroundings {
        terrain: &terrain,
        people: &people,
        ..Surroundings::default()
    };
    let mut one = creature(&kind, CreatureConfig::default());
    let entered = entered(&mut one, &around);
    assert!((10..=42).contains(&entered), "{entered}");
    assert!(one.attack().is_none());
}

/// A game that sends it again whenever it is told that it does not get there.
#[test]
fn who_is_sent_again_and_again_tries_for_a_while() {
    let poses = BodyPoses::default();
    let world = pen();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let kind = kind(&brain_with("stands", STATES));
    let mut one = creature(&kind, CreatureConfig::default());
    let mut stopped = 0;
    for _ in 0..1200 {
        if one.sent_to().is_none() {
            assert!(one.send(Some(DVec3::new(-60.0, 0.0, 6.0))));
        }
        let report = one.step(&around).unwrap();
        let is_stopped = |event: &&CreatureEvent| matches!(event, CreatureEvent::Stopped { .. });
        stopped += report.events.iter().filter(is_stopped).count();
    }
    println!("stopped {stopped} times in 20 s");
    assert!((5..=20).contains(&stopped), "{stopped}");
}

/// Feet come under the body again, whatever it did before, and both at once if both are elsewhere.
#[test]
fn feet_come_under_the_body_after_a_turn_without_a_clip() {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let mut file: serde_json::Value = serde_json::from_str(&brain_with("stands", STATES)).unwrap();
    let gait = file["body"]["gait"].as_object_mut().unwrap();
    gait.remove("turn");
    let kind = kind(&file.to_string());
    // From heel to toe.
    let points = |one: &Creature, leg: usize| {
        let [heel, _, _, toe] = one.sole(leg).unwrap();
        let way = (toe - heel).with_y(0.0);
        let ahead = heading(one);
        libm::atan2(ahead.cross(way).y, ahead.dot(way))
    };
    let mut fresh = creature(&kind, CreatureConfig::default());
    fresh
        .step(&Surroundings {
            terrain: &terrain,
            ..Surroundings::default()
        })
        .unwrap();
    let rests = [0, 1].map(|leg| points(&fresh, leg));
    for step in 0..16 {
        let angle = PI * (0.15 + 0.11 * f64::from(step));
        let place = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * 40.0;
        let people = [person(place)];
        let around = Surroundings {
            terrain: &terrain,
            people: &people,
            ..Surroundings::default()
        };
        let mut one = creature(&kind, CreatureConfig::default());
        for seconds in [f64::from(step) * 0.21, 30.0] {
            assert!(one.enter(if seconds < 20.0 { "walks" } else { "turns" }));
            for _ in 0..(seconds / TICK) as u32 {
                one.step(&around).unwrap();
            }
        }
        assert!(one.enter("stands"));
        for _ in 0..600 {
            one.step(&around).unwrap();
        }
        for (leg, rest) in rests.iter().enumerate() {
            let turned = points(&one, leg) - rest;
            let turned = (turned + PI).rem_euclid(TAU) - PI;
            println!("{angle:.2}: leg {leg} turned by {turned:.3}");
            assert!(turned.abs() < 0.5, "{angle}: leg {leg} {turned}");
        }
    }
}

/// A foot beyond a cliff hangs there, and does not come down again and again.
#[test]
fn a_foot_over_nothing_stays_where_it_is() {
    let kind = kind(&brain_with("stands", STATES));
    let mut world = PhysicsWorld::default();
    let rock = ColliderBuilder::cuboid(30.0, 1.0, 60.0);
    world.insert_collider(
        rock.position(Pose::from_translation(Vec3::new(-30.0, -1.0, 0.0))),
        None,
    );
    world.detect_collisions(&(), &());
    let poses = BodyPoses::default();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let mut one = creature(&kind, CreatureConfig::default());
    let mut planted = 0;
    for tick in 0..1200 {
        let report = one.step(&around).unwrap();
        let is_plant = |event: &&CreatureEvent| matches!(event, CreatureEvent::Plant { .. });
        if tick > 180 {
            planted += report.events.iter().filter(is_plant).count();
        }
    }
    println!("came down {planted} times in 17 s");
    assert!(planted <= 1, "{planted}");
}
