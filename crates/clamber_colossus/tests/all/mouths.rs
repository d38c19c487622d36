//! Mouths and hands aim as feet do: they move to the person that they strike, and back.

use std::sync::Arc;

use crate::support::{TICK, joint_place, level_ground, on_terrain, person, test_rig, with_people};
use clamber_colossus::{Brain, BrainFile, Creature, CreatureConfig, CreatureKind};
use glam::DVec3;
use serde_json::{Value, json};

/// An animal that waits for a second and then runs the attack that is proposed for it. It dies if its only weak point
/// is used up.
fn animal(file: &str, height: f64, aim: f64) -> Option<Arc<CreatureKind>> {
    let rig = test_rig(file)?;
    let proposed = BrainFile::propose(&rig, height).unwrap();
    let proposed = serde_json::to_value(&proposed).unwrap();
    let mut act: Value =
        proposed["states"]["alive"]["states"]["alert"]["states"]["strikes"]["act"].clone();
    act["attack"]["aim"] = aim.into();
    // Removes the shock wave that is proposed for a mouth high above people.
    act["attack"].as_object_mut().unwrap().remove("wave");
    let brain = json!({
        "body": proposed["body"],
        "start": "waits",
        "states": {
            "waits": { "transitions": [{ "to": "strikes", "after": 1 }] },
            "strikes": { "act": act, "transitions": [
                { "to": "ends" }, { "to": "dies", "when": ["health <= 0"], "interrupts": true, "priority": 1 }] },
            "ends": { "final": true },
            "dies": { "act": proposed["states"]["dies"]["act"], "fade": 0.3, "final": true }
        }
    });
    let brain = Brain::from_json(&brain.to_string(), TICK).unwrap();
    Some(Arc::new(CreatureKind::new(&rig, brain).unwrap()))
}

/// The place in the world where the attack strikes without an aim: the last position of the joint at the limb's end
/// while it hurts.
fn spot(kind: &Arc<CreatureKind>) -> DVec3 {
    let mut creature = Creature::new(Arc::clone(kind), CreatureConfig::default()).unwrap();
    let brain = kind.brain();
    let strikes = brain.find("strikes").unwrap();
    let Some(clamber_colossus::brain::StateAction::Attack(attack)) = brain.act(strikes) else {
        unreachable!("it attacks");
    };
    let end = kind.skeleton().find(attack.limb.last().unwrap()).unwrap();
    let terrain = level_ground();
    let mut last = DVec3::ZERO;
    for _ in 0..1_200 {
        creature.step(&on_terrain(&terrain)).unwrap();
        if creature
            .attack()
            .is_some_and(|(_, phase)| phase == clamber_colossus::AttackPhase::Active)
        {
            last = joint_place(&creature, end);
        }
    }
    last
}

/// Counts the struck people among 48 at places up to `within` metres around the spot. Each is attacked alone.
fn struck(kind: &Arc<CreatureKind>, spot: DVec3, within: f64) -> usize {
    let mut count = 0;
    for place in 0..48 {
        let turn = f64::from(place) * 2.4;
        let share = (f64::from(place) + 0.5) / 48.0;
        let aside = DVec3::new(libm::cos(turn), 0.0, libm::sin(turn)) * (within * share.sqrt());
        let victim = person(spot + aside - DVec3::Y * 0.875);
        let mut creature = Creature::new(Arc::clone(kind), CreatureConfig::default()).unwrap();
        let terrain = level_ground();
        let people = [victim];
        for _ in 0..1_200 {
            if !creature
                .step(&with_people(&terrain, &people))
                .unwrap()
                .blows
                .is_empty()
            {
                count += 1;
                break;
            }
        }
    }
    count
}

#[test]
fn a_mouth_goes_to_whom_it_bites() {
    for (file, height) in [
        ("Trex.glb", 12.0),
        ("Trex.glb", 30.0),
        ("Bull.glb", 12.0),
        ("George.glb", 12.0),
    ] {
        let within = 0.25 * height;
        let Some(without) = animal(file, height, 0.0) else {
            return;
        };
        let spot = spot(&without);
        let with = animal(file, height, 1.2 * within).unwrap();
        let counts = [&without, &with].map(|kind| struck(kind, spot, within));
        println!(
            "{file} at {height} m: {} of 48 without an aim, {} with one",
            counts[0], counts[1]
        );
        // The neck does not reach all 48 people.
        assert!(
            counts[1] >= 24 && counts[1] >= counts[0] + 8,
            "{file}: {counts:?}"
        );
    }
}

/// The largest acceleration of the head in a tick, metres a second squared, and its place in each tick, over an attack
/// on a person. If `dies` is given, the animal dies in that tick.
fn jerk(kind: &Arc<CreatureKind>, at: DVec3, dies: Option<usize>) -> (f64, Vec<DVec3>) {
    let mut creature = Creature::new(Arc::clone(kind), CreatureConfig::default()).unwrap();
    let terrain = level_ground();
    let people = [person(at - DVec3::Y * 0.875)];
    let end = kind.skeleton().find("Head").unwrap();
    let (mut before, mut speed): (Option<DVec3>, Option<DVec3>) = (None, None);
    let (mut worst, mut way) = (0f64, Vec::new());
    for tick in 0..400 {
        if dies == Some(tick) {
            assert!(creature.harm(0, 100.0).is_some());
        }
        creature.step(&with_people(&terrain, &people)).unwrap();
        let now = joint_place(&creature, end);
        let moved = before.map(|before| (now - before) / TICK);
        if let (Some(a), Some(b)) = (moved, speed) {
            worst = worst.max(a.distance(b) / TICK);
        }
        (before, speed) = (Some(now), moved);
        way.push(now);
    }
    (worst, way)
}

#[test]
fn a_neck_goes_out_and_back_without_a_jump() {
    let height = 20.0;
    let Some(without) = animal("Trex.glb", height, 0.0) else {
        return;
    };
    let with = animal("Trex.glb", height, 5.0).unwrap();
    let at = spot(&without) + DVec3::new(2.0, -1.0, 1.0);
    for dies in [None, Some(70), Some(100), Some(130), Some(160)] {
        let [(plain, clip), (aimed, leant)] = [&without, &with].map(|kind| jerk(kind, at, dies));
        let apart = clip.iter().zip(&leant).map(|(a, b)| a.distance(*b));
        let most = apart.fold(0.0, f64::max);
        println!(
            "dies at {dies:?}: {plain:.0} m/s² without an aim, {aimed:.0} with one, up to {most:.1} m aside"
        );
        assert!(aimed < plain + 3.0 * 9.81, "{dies:?}: {plain} {aimed}");
        assert!(most > 0.3, "{dies:?}: {most}");
        // In the end the head is back where the clip has it.
        let end = clip[399].distance(leant[399]);
        assert!(end < 1e-3 * height, "{end}");
    }
}
