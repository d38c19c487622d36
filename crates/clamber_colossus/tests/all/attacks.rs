//! The giant's attacks leave time to run away, strike by touch, and strike only in their window. Scenes B39 and B40.

use crate::ranged::{attack as ranged_attack, places, somebody, wall};
use crate::support::{
    TICK, add_block, all_cases, brain_file, brain_with, creature, kind, kind_at, level_ground,
    person, terrain_of, with_people,
};
use clamber_animation::rig::Playback;
use clamber_animation::{joint_in_model, rig::JointId};
use clamber_colossus::brain::StateAction;
use clamber_colossus::{Creature, CreatureConfig, CreatureEvent};
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{HalfSpace, Obstacle};
use glam::DVec3;

/// The attack states of the giant's own brain, each with its act as JSON.
pub(crate) fn attacks() -> Vec<(String, serde_json::Value)> {
    fn collect(states: &serde_json::Value, found: &mut Vec<(String, serde_json::Value)>) {
        for (name, state) in states.as_object().into_iter().flatten() {
            if state["act"]["attack"].is_object() {
                found.push((name.clone(), state["act"].clone()));
            }
            collect(&state["states"], found);
        }
    }
    let file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    let mut found = Vec::new();
    collect(&file["states"], &mut found);
    found
}

/// The giant, standing, one second before an attack.
pub(crate) fn before(act: &serde_json::Value) -> Creature {
    before_at(act, TICK, CreatureConfig::default())
}

/// [`before`] with ticks of another length, and a config with another size.
pub(crate) fn before_at(act: &serde_json::Value, tick: f64, config: CreatureConfig) -> Creature {
    let states = serde_json::json!({
        "waits": { "transitions": [{ "to": "attacks", "after": 1 }] },
        "attacks": { "act": act, "transitions": [{ "to": "ends" }] },
        "ends": { "final": true }
    });
    let kind = kind_at(&brain_with("waits", &states.to_string()), tick);
    creature(&kind, config)
}

/// The result of one attack on one person.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    hits: usize,
    /// Seconds from the start of the attack's clip to the blow.
    time: f64,
    /// Angle between the blow's velocity and the limb's velocity at the place of the blow, degrees.
    aside: f64,
}

/// Runs an attack on a person at a place. If `flees`, the person runs away at 3 m/s from 0.3 s on.
fn attack(before: &Creature, at: DVec3, flees: bool) -> Outcome {
    let mut giant = before.clone();
    let terrain = level_ground();
    let mut victim = person(at);
    let away = (at - giant.state().position()).with_y(0.0).normalize();
    let mut outcome = Outcome {
        hits: 0,
        time: f64::NAN,
        aside: 0.0,
    };
    let mut begun: Option<usize> = None;
    let brain = giant.kind().brain();
    let Some(StateAction::Attack(act)) = brain.act(brain.find("attacks").unwrap()) else {
        unreachable!("the state attacks");
    };
    // Only the joints of the limb count: some joint of the whole body would move along any blow.
    let is_limb = |name: &str| {
        act.limb
            .iter()
            .any(|pattern| match pattern.split_once('*') {
                Some((start, end)) => name.starts_with(start) && name.ends_with(end),
                None => name == pattern,
            })
    };
    let joints = giant.kind().skeleton().joints().iter().enumerate();
    let joints: Vec<JointId> = joints
        .filter(|(_, joint)| is_limb(&joint.name))
        .map(|(index, _)| JointId(index as u32))
        .collect();
    for tick in 0..700 {
        let from = giant.palette().clone();
        let world_before = *giant.surface().world_from_model();
        let people = [victim];
        let report = giant.step(&with_people(&terrain, &people)).unwrap().clone();
        for event in &report.events {
            if let CreatureEvent::Entered { to, .. } = event {
                match giant.kind().brain().path(*to) {
                    "attacks" => begun = Some(tick),
                    "ends" => return outcome,
                    _ => {}
                }
            }
        }
        if let (Some(begun), Some(blow)) = (begun, report.blows.first()) {
            outcome.hits += report.blows.len();
            outcome.time = (tick - begun) as f64 * TICK;
            // The skin at the blow moves rigidly with a joint of the limb, apart from blending. Takes the joint that
            // fits best.
            let world = giant.surface().world_from_model();
            let motion = |joint: &JointId| {
                let now = giant.palette().model_from_joint(*joint).unwrap();
                let was = from.model_from_joint(*joint).unwrap();
                let local = now
                    .inverse()
                    .transform_point3(world.inverse_transform_point(blow.place));
                let before = world_before.transform_point(was.transform_point3(local));
                blow.place - before
            };
            let asides = joints
                .iter()
                .map(|joint| angle(motion(joint), blow.velocity));
            outcome.aside = asides.fold(f64::INFINITY, f64::min).to_degrees();
        }
        let flees_now = flees && begun.is_some_and(|begun| (tick - begun) as f64 * TICK >= 0.3);
        if flees_now {
            victim = person(victim.body.ends[0].with_y(0.0) + away * (3.0 * TICK));
        }
    }
    unreachable!("the attack does not end");
}

/// The angle between two vectors, radians.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::acos(
        a.normalize_or_zero()
            .dot(b.normalize_or_zero())
            .clamp(-1.0, 1.0),
    )
}

/// The place in model space where an attack strikes: the end of its limb at the marker `recovery`, when it stops
/// hurting.
pub(crate) fn spot(giant: &Creature, act: &serde_json::Value) -> DVec3 {
    let kind = giant.kind();
    let attack = &act["attack"];
    let clip = kind.clips().find(attack["clip"].as_str().unwrap()).unwrap();
    let clip = kind.clips().clip(clip).unwrap();
    let limb = attack["limb"].as_array().unwrap();
    let end = limb.last().unwrap().as_str().unwrap();
    let recovery = clip
        .markers()
        .iter()
        .find(|one| one.name == "recovery")
        .unwrap();
    let pose = clip
        .sample(&kind.skeleton().rest_pose(), recovery.time, Playback::Clamp)
        .unwrap();
    let joint = kind.skeleton().find(end).unwrap();
    joint_in_model(kind.skeleton(), &pose, joint)
        .unwrap()
        .translation
}

#[test]
fn a_stomp_hits_who_stays_and_spares_who_runs() {
    for (name, act) in attacks()
        .iter()
        .filter(|(name, _)| name.starts_with("stomp"))
    {
        let giant = before(act);
        let spot = spot(&giant, act);
        let aim = act["attack"]["aim"].as_f64().unwrap();
        let mut random = fastrand::Rng::with_seed(1);
        let (mut hit, mut escaped) = (0, 0);
        /// Number of people around the spot. Each is attacked twice: once it stays, and once it runs away.
        const COUNT: usize = 500;
        for _ in 0..COUNT {
            let (angle, reach) = (
                random.f64() * core::f64::consts::TAU,
                random.f64().sqrt() * aim,
            );
            let at = spot + DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * reach;
            let stays = attack(&giant, at.with_y(0.0), false);
            let runs = attack(&giant, at.with_y(0.0), true);
            hit += usize::from(stays.hits > 0);
            escaped += usize::from(runs.hits == 0);
            assert!(stays.hits <= 1 && runs.hits <= 1, "{stays:?} {runs:?}");
        }
        println!("{name}: {hit} of {COUNT} who stay are hit, {escaped} of {COUNT} who run escape");
        assert!(
            hit >= COUNT * 90 / 100 && escaped >= COUNT * 95 / 100,
            "{name}: {hit} {escaped}"
        );
    }
}

#[test]
fn blows_come_in_the_window_and_along_the_limb() {
    for (name, act) in attacks() {
        let giant = before(&act);
        let spot = spot(&giant, &act).with_y(0.0);
        let clip = act["attack"]["clip"].as_str().unwrap();
        let clip = giant.kind().clips().find(clip).unwrap();
        let markers = giant.kind().clips().clip(clip).unwrap().markers();
        let time = |name: &str| markers.iter().find(|one| one.name == name).unwrap().time;
        let window = [time("active") - TICK, time("recovery") + TICK];
        let (mut hits, mut worst) = (0, 0f64);
        let mut places = Vec::new();
        let every = if all_cases() { 1 } else { 2 };
        for x in (-14..=14).step_by(every) {
            for z in (-4..=16).step_by(every) {
                let at = DVec3::new(f64::from(x) * 2.0, 0.0, f64::from(z) * 2.0);
                let outcome = attack(&giant, at, false);
                assert!(outcome.hits <= 1, "{name}: {outcome:?}");
                if outcome.hits == 1 {
                    (hits, worst) = (hits + 1, worst.max(outcome.aside));
                    assert!(
                        (window[0]..=window[1]).contains(&outcome.time),
                        "{name} at {at}: {outcome:?}, active in {window:?}"
                    );
                    places.push([at.x, at.z]);
                }
            }
        }
        let range = |axis: usize| {
            let all = places.iter().map(|place| place[axis]);
            [
                all.clone().fold(f64::INFINITY, f64::min),
                all.fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        println!(
            "{name}: window {window:.2?}, spot {spot:.1}, hits at {hits} places, x {:?} z {:?}, at most {worst:.1} degrees aside",
            range(0),
            range(1)
        );
        assert!(hits > 0, "{name}");
        assert!(worst <= 10.0, "{name}: {worst} degrees");
    }
}

/// The foot that stomped stands where it came down until its clip lifts it, wherever the prey is.
#[test]
fn a_stomp_stands_where_it_came_down() {
    let (_, act) = attacks()
        .into_iter()
        .find(|(name, _)| name == "stomp_right")
        .unwrap();
    let before = before(&act);
    let terrain = level_ground();
    let mut furthest = 0f64;
    for (distance, degrees) in [2.0, 6.0, 9.0, 12.0, 20.0]
        .into_iter()
        .flat_map(|distance| [-80.0f64, -40.0, 0.0, 40.0].map(|degrees| (distance, degrees)))
    {
        let angle = degrees.to_radians();
        let at = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * distance;
        let mut giant = before.clone();
        let people = [person(at)];
        let (mut down, mut stood) = (None, 0);
        for tick in 0..400 {
            let report = giant.step(&with_people(&terrain, &people)).unwrap();
            let landed = report.events.iter().find_map(|event| match event {
                CreatureEvent::Plant { leg: 1, place } => Some(*place),
                _ => None,
            });
            if let (None, Some(place)) = (down, landed) {
                down = Some((tick, place));
                furthest = furthest.max(place.with_y(0.0).length());
            }
            // The clip lifts the foot one second after it came down.
            let Some((since, _)) = down.filter(|(since, _)| (6..54).contains(&(tick - since)))
            else {
                continue;
            };
            let what = format!("{distance} m, {degrees} degrees, {} ticks", tick - since);
            assert!(giant.state().is_planted(1), "{what}");
            let clearance = giant.foot_clearance(1, &terrain).unwrap();
            let share = clearance / giant.kind().foot_length(1);
            assert!(share.abs() < 0.01, "{what}: {clearance} m");
            stood += 1;
        }
        assert_eq!(stood, 48, "{distance} m, {degrees} degrees");
    }
    // The foot does aim: it comes down farther out than its clip has it.
    assert!(furthest > 9.5, "{furthest}");
}

/// An attack that is left for another act strikes nobody any more, even while the pose of its clip remains.
#[test]
fn an_attack_ends_with_its_act() {
    let terrain = level_ground();
    for (name, act) in attacks() {
        for next in [r#""act": "sleep""#, r#""final": true"#] {
            let states = format!(
                r#"{{
                "waits": {{ "transitions": [{{ "to": "attacks", "after": 0.5 }}] }},
                "attacks": {{ "act": {act}, "transitions": [
                    {{ "to": "ends", "on": "active", "interrupts": true }}] }},
                "ends": {{ {next} }} }}"#
            );
            let mut giant = creature(
                &kind(&brain_with("waits", &states)),
                CreatureConfig::default(),
            );
            let ends = giant.kind().brain().find("ends").unwrap();
            let (mut blows, mut left) = (0, 0);
            for _ in 0..600 {
                // People stand all around the giant.
                let place = |index: u64| {
                    let (x, z) = (index % 13, index / 13);
                    let at = DVec3::new(x as f64 * 3.0 - 18.0, 0.0, z as f64 * 3.0 - 10.0);
                    clamber_colossus::Person {
                        id: index,
                        ..person(at)
                    }
                };
                let people: Vec<_> = (0..169).map(place).collect();
                let report = giant.step(&with_people(&terrain, &people)).unwrap();
                let dealt = report.blows.len();
                if giant.state().current() == ends {
                    left += 1;
                    blows += dealt;
                    assert_eq!(giant.attack(), None, "{name}");
                }
            }
            assert!(left > 100, "{name}");
            assert_eq!(blows, 0, "{name}, then {next}");
        }
    }
}

/// A gate that closes after an attack has begun protects the people behind it, even from a limb that passes through it.
/// A low wall protects them from limbs whose joints do not come over it.
#[test]
fn nobody_is_struck_through_a_gate_that_closes() {
    let ground = HalfSpace::below(0.0);
    // Solid ground does not block a foot whose joints are inside of it.
    let mut world = PhysicsWorld::default();
    let half = DVec3::new(200.0, 1.0, 200.0);
    add_block(&mut world, DVec3::NEG_Y, half);
    let slab = terrain_of(&world);
    let (mut open, mut behind, mut low) = (0, 0, 0);
    for (name, act) in attacks() {
        let giant = before(&act);
        for (place, _) in places(DVec3::new(0.0, 0.0, 9.0), 9.0, 5)
            .into_iter()
            .take(40)
        {
            let to = place.with_y(0.0).normalize_or(DVec3::Z);
            let aside = DVec3::new(to.z, 0.0, -to.x);
            let gate = |height| wall(place - to * 0.6 - aside * 30.0, aside * 60.0, height);
            let struck = |gate: Option<&dyn Obstacle>| {
                let terrain = |since: f64| {
                    let gate = gate.filter(|_| since > 0.1);
                    std::iter::once(&ground as &dyn Obstacle)
                        .chain(gate)
                        .collect()
                };
                let seen = ranged_attack(&giant, |_| vec![somebody(1, place)], terrain);
                seen.blows.len()
            };
            if struck(None) > 0 {
                let on_slab = ranged_attack(&giant, |_| vec![somebody(1, place)], |_| vec![&slab]);
                assert!(!on_slab.blows.is_empty(), "{name} at {place} on a slab");
                let through = struck(Some(&gate(40.0)));
                assert_eq!(through, 0, "{name} at {place}");
                low += struck(Some(&gate(2.4)));
                open += 1;
            }
            behind += 1;
        }
    }
    println!(
        "{open} of {behind} in the open, {low} of them behind a wall of 2.4 m, none behind one of 40 m"
    );
    assert!(open > 30 && low < open);
}
