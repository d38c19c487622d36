//! A brain or a game that changes its decision in each tick.

use core::f64::consts::{PI, TAU};

use clamber_animation::rig::Palette;
use clamber_colossus::{Creature, CreatureEvent, Foresight};
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{HalfSpace, Obstacle};
use glam::{DVec3, Vec3};

use crate::support::life::{Guest, Life, SETTINGS, at};
use crate::support::{add_block, all_cases, brain_with, ground, terrain_of};

/// The states between which the tests switch, as JSON.
const STATES: &str = r#"{
    "stands": { "fade": 0.8 },
    "swipes": { "act": { "play": "swipe" } },
    "kicks": { "act": { "play": "kick_left" } },
    "shakes": { "act": { "play": "shake" } },
    "turns": { "act": { "turn": { "to": "prey", "within_deg": 15 } } },
    "walks": { "act": { "walk": { "to": "patrol", "within": 1 } } },
    "idles": { "act": { "play": "idle" }, "fade": 0.3 }
}"#;

/// The height of the skin above the creature's origin, and its largest level distance from there, metres.
fn size(life: &Life<'_>) -> [f64; 2] {
    let mut skin: Vec<Vec3> = Vec::new();
    life.one.surface().clone().skin_all(&mut skin);
    let most = |of: fn(&Vec3) -> f32| f64::from(skin.iter().map(of).fold(0.0, f32::max));
    let scale = life.one.surface().world_from_model().scale;
    [
        scale * most(|place| place.y),
        scale * most(|place| place.with_y(0.0).length()),
    ]
}

/// Fades that restart in each tick do not stretch the giant's limbs, at any start time within its clips. Its planted
/// feet stay on the ground.
#[test]
fn who_changes_states_in_each_tick_keeps_its_shape() {
    let ground = HalfSpace::below(0.0);
    let people = [at(-1.9, 32.0)];
    let brain = brain_with("stands", STATES);
    let mut cases = Vec::new();
    for before in ["swipes", "kicks", "shakes"] {
        for between in [["stands", "turns"], ["idles", "walks"], ["stands", "idles"]] {
            let times: &[f64] = if all_cases() {
                &[0.4, 0.9, 1.7]
            } else {
                &[0.9]
            };
            for seconds in times {
                cases.push((SETTINGS[0], before, between, *seconds));
            }
        }
    }
    for setting in &SETTINGS[1..] {
        cases.push((*setting, "swipes", ["stands", "turns"], 0.9));
        cases.push((*setting, "kicks", ["idles", "walks"], 0.4));
    }
    for (setting, before, between, seconds) in cases {
        let mut life = Life::new(setting, &brain, &ground);
        let [height, _] = size(&life);
        assert!(life.one.enter(before));
        life.live(&people, seconds, |_| {});
        let [_, width] = size(&life);
        let mut most = [0.0f64; 3];
        for tick in 0..300 {
            assert!(life.one.enter(between[tick % 2]));
            life.tick(&people);
            let [high, wide] = size(&life);
            most[0] = most[0].max(high / height);
            most[1] = most[1].max(wide / width.max(0.5 * height));
            if tick < 120 || life.one.state().speed() != 0.0 {
                continue;
            }
            let terrain: [&dyn Obstacle; 1] = [&life.ground];
            for leg in (0..2).filter(|leg| life.one.state().is_planted(*leg)) {
                let clearance = life.one.foot_clearance(leg, &terrain).unwrap();
                let length = life.one.kind().foot_length(leg) * life.one.scale();
                most[2] = most[2].max((clearance / length).abs());
            }
        }
        let what = format!("{setting:?}, {before} for {seconds} s, then {between:?}");
        println!("{what}: {most:.4?}");
        assert!(most[0] < 1.04 && most[1] < 1.1, "{what}: {most:?}");
        assert!(most[2] < 0.005, "{what}: {most:?}");
    }
}

fn heading(one: &Creature) -> DVec3 {
    let yaw = one.state().yaw();
    DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw))
}

/// A pen of rock around the origin in which the giant cannot turn. `scale` is the giant's size relative to 41 m.
pub(crate) fn pen(scale: f64) -> PhysicsWorld {
    let mut world = ground(|_, _| 0.0);
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let at = (DVec3::new(x, 0.0, z) * 19.0 + DVec3::Y * 8.0) * scale;
        let size = DVec3::new(10.0, 8.0, 10.0) * scale;
        add_block(&mut world, at, size);
    }
    world
}

/// The number of states that the giant enters in 20 s.
fn entered(life: &mut Life<'_>, people: &[Guest]) -> usize {
    let mut entered = 0;
    for _ in 0..life.setting.ticks(20.0) {
        let is_entered = |event: &&CreatureEvent| matches!(event, CreatureEvent::Entered { .. });
        entered += life.tick(people).iter().filter(is_entered).count();
    }
    println!("{:?}: entered {entered} states in 20 s", life.setting);
    entered
}

/// If the giant cannot turn to its prey, it tries for a while before its brain is told. It is not foreseen to turn.
#[test]
fn who_cannot_turn_tries_for_a_while() {
    let states = r#"{
        "hunt": { "transitions": [
            { "to": "face", "any": ["prey_bearing_deg > 70", "prey_bearing_deg < -70"] }
        ] },
        "face": { "act": { "turn": { "to": "prey", "within_deg": 15 } }, "transitions": [
            { "to": "hunt", "when": ["END"] }
        ] }
    }"#;
    for setting in SETTINGS {
        let world = pen(setting.scale());
        let terrain = terrain_of(&world);
        let people = [at(-1.47, 60.0)];
        for end in ["done", "blocked"] {
            let brain = brain_with("hunt", &states.replace("END", end));
            let mut life = Life::new(setting, &brain, &terrain);
            let entered = entered(&mut life, &people);
            assert!(
                (10..=42).contains(&entered),
                "{setting:?}, {end}: {entered}"
            );
            assert!(life.yaw().abs() < 0.2, "{setting:?}: it turned");
            for _ in 0..40 {
                life.tick(&people);
                let mut palette = Palette::default();
                let seconds = 2.0 * setting.pace();
                let then = life
                    .one
                    .foresee(seconds, &mut Foresight::default(), &mut palette)
                    .unwrap();
                let ahead = then.rotation * DVec3::Z;
                // The ship keeps turning in the foreseen time.
                let carried = if setting.sails { 0.05 * seconds } else { 0.0 };
                let turned = libm::atan2(ahead.x, ahead.z) - life.one.state().yaw() - carried;
                assert!(
                    turned.abs() < 0.05,
                    "{setting:?}: foreseen to turn by {turned}"
                );
            }
        }
    }
}

/// A brain without a pause asks for an attack again and again. The attack does not begin, as rock is in its way.
#[test]
fn who_cannot_strike_tries_for_a_while() {
    let states = r#"{
        "hunt": { "transitions": [{ "to": "stomp", "when": ["prey_seen"] }] },
        "stomp": { "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"], "damage": 0.6, "throw": 9 } },
            "transitions": [{ "to": "hunt" }] }
    }"#;
    for setting in SETTINGS {
        let mut world = ground(|_, _| 0.0);
        let wall = [DVec3::new(0.0, 6.0, 8.0), DVec3::new(40.0, 6.0, 2.0)];
        let [at_wall, half] = wall.map(|one| one * setting.scale());
        add_block(&mut world, at_wall, half);
        let terrain = terrain_of(&world);
        let mut life = Life::new(setting, &brain_with("hunt", states), &terrain);
        let entered = entered(&mut life, &[at(0.0, 40.0)]);
        assert!((10..=42).contains(&entered), "{setting:?}: {entered}");
        assert!(life.one.attack().is_none(), "{setting:?}");
    }
}

/// A game sends the giant again whenever it reports that it cannot get there.
#[test]
fn who_is_sent_again_and_again_tries_for_a_while() {
    for setting in SETTINGS {
        let world = pen(setting.scale());
        let terrain = terrain_of(&world);
        let mut life = Life::new(setting, &brain_with("stands", STATES), &terrain);
        let mut stopped = 0;
        for _ in 0..setting.ticks(20.0) {
            if life.one.sent_to().is_none() {
                let goal = life.place(DVec3::new(-60.0, 0.0, 6.0));
                assert!(life.one.send(Some(goal)));
            }
            let is_stopped =
                |event: &&CreatureEvent| matches!(event, CreatureEvent::Stopped { .. });
            stopped += life.tick(&[]).iter().filter(is_stopped).count();
        }
        println!("{setting:?}: stopped {stopped} times in 20 s");
        assert!((5..=20).contains(&stopped), "{setting:?}: {stopped}");
    }
}

/// After a turn without a clip, the feet come back under the body from any position, even if both are out of place.
#[test]
fn feet_come_under_the_body_after_a_turn_without_a_clip() {
    let ground = HalfSpace::below(0.0);
    let mut file: serde_json::Value = serde_json::from_str(&brain_with("stands", STATES)).unwrap();
    let gait = file["body"]["gait"].as_object_mut().unwrap();
    gait.remove("turn");
    let brain = file.to_string();
    // The angle from the heading to the line from heel to toe, radians.
    let points = |one: &Creature, leg: usize| {
        let [heel, _, _, toe] = one.sole(leg).unwrap();
        let way = (toe - heel).with_y(0.0);
        let ahead = heading(one);
        libm::atan2(ahead.cross(way).y, ahead.dot(way))
    };
    for (index, setting) in SETTINGS.into_iter().enumerate() {
        let mut fresh = Life::new(setting, &brain, &ground);
        fresh.tick(&[]);
        let rests = [0, 1].map(|leg| points(&fresh.one, leg));
        let every = match index {
            0 if all_cases() => 1,
            0 => 3,
            _ => 5,
        };
        for step in (0..16).step_by(every) {
            let angle = PI * (0.15 + 0.11 * f64::from(step));
            let people = [at(angle, 40.0)];
            let mut life = Life::new(setting, &brain, &ground);
            for seconds in [f64::from(step) * 0.21, 30.0] {
                let state = if seconds < 20.0 { "walks" } else { "turns" };
                assert!(life.one.enter(state));
                life.live(&people, seconds, |_| {});
            }
            assert!(life.one.enter("stands"));
            life.live(&people, 10.0, |_| {});
            for (leg, rest) in rests.iter().enumerate() {
                let turned = points(&life.one, leg) - rest;
                let turned = (turned + PI).rem_euclid(TAU) - PI;
                println!("{setting:?}, {angle:.2}: leg {leg} turned by {turned:.3}");
                assert!(
                    turned.abs() < 0.5,
                    "{setting:?}, {angle}: leg {leg} {turned}"
                );
            }
        }
    }
}

/// A foot beyond the edge of a cliff hangs in the air, and does not come down again and again.
#[test]
fn a_foot_over_nothing_stays_where_it_is() {
    for setting in SETTINGS {
        let mut world = PhysicsWorld::default();
        let rock = [DVec3::new(-30.0, -1.0, 0.0), DVec3::new(30.0, 1.0, 60.0)];
        let [at_rock, half] = rock.map(|one| one * setting.scale());
        add_block(&mut world, at_rock, half);
        let terrain = terrain_of(&world);
        let mut life = Life::new(setting, &brain_with("stands", STATES), &terrain);
        let mut planted = 0;
        for tick in 0..setting.ticks(20.0) {
            let is_plant = |event: &&CreatureEvent| matches!(event, CreatureEvent::Plant { .. });
            let planted_now = life.tick(&[]).iter().filter(is_plant).count();
            if tick > setting.ticks(3.0) {
                planted += planted_now;
            }
        }
        println!("{setting:?}: came down {planted} times in 17 s");
        assert!(planted <= 1, "{setting:?}: {planted}");
    }
}
