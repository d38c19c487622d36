//! A brain, or a game, that changes its mind in each tick.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, Surroundings};
use clamber_world::rapier3d::prelude::{ColliderBuilder, Pose};
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
                    most[0] < 1.15 && most[1] < 1.3,
                    "{before} {between:?}: {most:?}"
                );
                assert!(most[2] < 0.005, "{before} {between:?}: {most:?}");
            }
        }
    }
}

/// Where it cannot turn to its prey, it tries for a while before its brain hears of it.
#[test]
fn who_cannot_turn_tries_for_a_while() {
    let states = r#"{
        "hunt": { "transitions": [
            { "to": "face", "any": ["prey_bearing_deg > 70", "prey_bearing_deg < -70"] }
        ] },
        "face": { "act": { "turn": { "to": "prey", "within_deg": 15 } }, "transitions": [
            { "to": "hunt", "when": ["done"] }
        ] }
    }"#;
    let kind = kind(&brain_with("hunt", states));
    let mut world = ground(|_, _| 0.0);
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let at = DVec3::new(x, 0.0, z) * 19.0 + DVec3::Y * 8.0;
        let wall = ColliderBuilder::cuboid(10.0, 8.0, 10.0);
        world.insert_collider(wall.position(Pose::from_translation(at.as_vec3())), None);
    }
    world.detect_collisions(&(), &());
    let poses = BodyPoses::default();
    let terrain = RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let people = [person(DVec3::new(-60.0, 0.0, 6.0))];
    let around = Surroundings {
        terrain: &terrain,
        people: &people,
        ..Surroundings::default()
    };
    let mut one = creature(&kind, CreatureConfig::default());
    let mut entered = 0;
    for _ in 0..1200 {
        let report = one.step(&around).unwrap();
        let is_entered = |event: &&CreatureEvent| matches!(event, CreatureEvent::Entered { .. });
        entered += report.events.iter().filter(is_entered).count();
    }
    println!("entered {entered} states in 20 s");
    assert!(one.state().yaw().abs() < 0.2, "it turned");
    assert!((10..=42).contains(&entered), "{entered}");
}
