//! The giant lives by its own brain. The brain is sound, and its life is the same on any thread and after a load.
//! Scenes B38 and B48.

use crate::support;

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::support::{
    TICK, brain_file, creature, ground, kind, level_ground, on_terrain, rider, terrain_of,
};
use clamber_colossus::brain::MOST_TRANSITIONS;
use clamber_colossus::{
    Brain, BrainState, CreatureConfig, CreatureKind, CreatureState, Noise, Person, RegionSense,
    Sense, Surroundings,
};
use clamber_surface::mesh::TriangleId;
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

/// The brain file in the documentation fits the giant.
#[test]
fn the_brain_of_the_documentation_fits_the_giant() {
    let form = include_str!("../../src/brain/form.md");
    let file = form.split("```json").nth(1).unwrap();
    let kind = support::kind(file.split("```").next().unwrap());
    assert_eq!(kind.brain().file().body.legs.len(), 2);
}

#[test]
fn limbs_that_are_none_are_refused_by_name() {
    let wrong = [
        (
            r#"["thigh.L", "shin.L", "foot.L"]"#,
            r#"["shin.L", "thigh.L", "foot.L"]"#,
            "the leg of `shin.L`, `thigh.L`, `foot.L` cannot be moved: in the skeleton, `thigh.L` is not below `shin.L`",
        ),
        (
            r#"["neck.1", 1]"#,
            r#"["hand.L", 1]"#,
            "the head of `head`, `hand.L` cannot be moved: in the skeleton, `head` is not below `hand.L`",
        ),
        (
            r#"["neck.1", 1]"#,
            r#"["neck.1", 2]"#,
            "the head of `head`, `neck.1` cannot be moved: a joint's share is not from 0 to 1",
        ),
    ];
    let form = include_str!("../../src/brain/form.md");
    let file = form.split("```json").nth(1).unwrap();
    let file = file.split("```").next().unwrap();
    for (right, wrong, message) in wrong {
        assert!(file.contains(right), "{right}");
        let error = support::try_kind(&file.replace(right, wrong)).unwrap_err();
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn acts_that_cannot_be_are_refused_where_they_stand() {
    let attack = r#""attack": { "clip": "stomp", "limb": ["tow.R"], "damage": 0.5, "throw": 9 }"#;
    let walk = r#""walk": { "to": "prey", "within": 8, "strike": "stomp" }"#;
    let comes = |act: &str| format!(r#"{{ "act": {{ {act} }} }}"#);
    for (states, state, message) in [
        (
            format!(r#"{{ "comes": {} }}"#, comes(walk)),
            "comes",
            "no state attacks with that",
        ),
        (
            format!(
                r#"{{ "comes": {}, "hits": {} }}"#,
                comes(walk),
                comes(attack)
            ),
            "hits",
            "there is no joint `tow.R`",
        ),
    ] {
        let error = support::try_kind(&support::brain_with("comes", &states)).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains(&format!("state `{state}`")) && error.contains(message),
            "{error}"
        );
    }
    let mut file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    file["body"].as_object_mut().unwrap().remove("gait");
    let error = support::try_kind(&file.to_string()).unwrap_err();
    assert!(
        error.to_string().contains("`body` has no `gait`"),
        "{error}"
    );
}

/// Random senses for a million ticks: each tick has few transitions, all states are reached, and death is reached from
/// every state and is final.
#[test]
fn its_brain_lives_through_anything() {
    let brain = Brain::from_json(&brain_file(), TICK).unwrap();
    let report = brain.report();
    assert!(report.never.is_empty(), "{report}");
    let die = brain.find("die").unwrap();
    let mut random = fastrand::Rng::with_seed(5);
    let (mut seen, mut died_from) = (BTreeSet::new(), BTreeSet::new());
    let mut state = BrainState::new(&brain, 1);
    let (mut senses, mut dies) = (brain.no_senses(), 1_000);
    for tick in 0..1_000_000u64 {
        for sense in Sense::all() {
            if random.u32(..60) == 0 {
                let numbers = [0.0, 0.0, 1.0, 3.0, 11.0, 15.0, 30.0, -30.0, -100.0, 100.0];
                senses.set(sense, numbers[random.usize(..numbers.len())]);
            }
        }
        for region in 0..brain.regions().len() {
            if random.u32(..60) == 0 {
                senses.set_in_region(RegionSense::Riders, region, f64::from(random.u32(..2)));
            }
        }
        if random.u32(..40) != 0 {
            senses.set(Sense::Hurt, 0.0);
            senses.set(Sense::Staggered, 0.0);
            senses.set(Sense::Struck, 0.0);
        }
        // Phases without prey, riders and noises take turns with phases with them.
        if tick % 4_000 < 1_500 {
            senses.set(Sense::PreySeen, 0.0);
            senses.set(Sense::Riders, 0.0);
            senses.set(Sense::Noise, 0.0);
        }
        dies -= 1;
        senses.set(Sense::Health, f64::from(u8::from(dies > 0)));
        let (before, mut count) = (state.current(), 0);
        brain.step(
            &mut state,
            &senses,
            &["active", "recovery", "impact"],
            |_| count += 1,
        );
        assert!(count <= MOST_TRANSITIONS, "{count}");
        assert!(state.size() <= 1024, "{} bytes", state.size());
        seen.insert(brain.path(state.current()).to_owned());
        if dies <= 0 {
            assert_eq!(
                state.current(),
                die,
                "not dead at once, from {}",
                brain.path(before)
            );
            died_from.insert(brain.path(before).to_owned());
        }
        if dies < -50 {
            let longest = if random.bool() { 5 } else { 800 };
            dies = i64::from(random.u32(2..longest));
            state = BrainState::new(&brain, tick);
            // The giant may die in any state.
            let all: Vec<_> = brain.states().collect();
            brain.go_to(&mut state, all[random.usize(..all.len())]);
        }
    }
    let innermost = |state: &clamber_colossus::brain::StateId| {
        brain
            .states()
            .all(|other| other == *state || !brain.is_within(other, *state))
    };
    for state in brain.states().filter(innermost) {
        let name = brain.path(state);
        assert!(seen.contains(name), "{name} was never seen");
        assert!(
            died_from.contains(name),
            "{name} was never followed by death"
        );
    }
}

/// A life among people that come, ride and leave, with arrows and noises.
struct Life {
    world: PhysicsWorld,
    kind: Arc<CreatureKind>,
}

impl Life {
    fn new() -> Self {
        Self {
            world: ground(|x, z| 1.5 * libm::sin(0.05 * x) * libm::cos(0.04 * z)),
            kind: kind(&brain_file()),
        }
    }

    /// The states of the life after every 1000 ticks. If `loads`, the state is also saved and loaded at random ticks.
    fn live(&self, ticks: u64, loads: bool) -> Vec<CreatureState> {
        let terrain = terrain_of(&self.world);
        let terrain: [&dyn Obstacle; 1] = [&terrain];
        let mut giant = creature(&self.kind, CreatureConfig::default());
        let mut states = Vec::new();
        let mut lots = fastrand::Rng::with_seed(9);
        let mut load = fastrand::Rng::with_seed(77);
        for tick in 0..ticks {
            let mut random = fastrand::Rng::with_seed(tick / 300);
            let mut people = Vec::new();
            for id in 0..3 {
                let (x, z) = (random.f64() * 80.0 - 40.0, random.f64() * 80.0 - 40.0);
                let at = DVec3::new(x, 0.0, z) + DVec3::X * (0.01 * (tick % 300) as f64);
                let rider = rider(at, TriangleId(random.u32(..1_000)));
                let riding = rider.riding.filter(|_| random.u32(..4) == 0);
                people.push(Person {
                    id,
                    riding,
                    ..rider
                });
            }
            let noise = Noise {
                place: DVec3::X * 30.0,
                loudness: 2.0,
            };
            let noises: &[Noise] = if lots.u32(..2_000) == 0 {
                &[noise]
            } else {
                &[]
            };
            if lots.u32(..1_500) == 0 {
                let triangle = TriangleId(lots.u32(..1_000));
                let at = MaterialPoint::on_triangle(triangle, [1.0 / 3.0; 3]);
                giant.hurt(&at, DVec3::Y * 20.0, 0.0);
            }
            giant
                .step(&Surroundings {
                    creatures: &[],
                    terrain: &terrain,
                    people: &people,
                    noises,
                })
                .unwrap();
            if loads && load.u32(..500) == 0 {
                let text = serde_json::to_string(giant.state()).unwrap();
                let state: CreatureState = serde_json::from_str(&text).unwrap();
                assert_eq!(&state, giant.state(), "tick {tick}");
                giant.restore(state).unwrap();
            }
            if tick % 1_000 == 999 {
                states.push(giant.state().clone());
            }
        }
        states
    }
}

#[test]
fn the_same_life_comes_out_on_any_thread_and_after_any_load() {
    /// Number of ticks of each long life.
    const TICKS: u64 = 100_000;
    let life = Life::new();
    let (one, two) = std::thread::scope(|scope| {
        let one = scope.spawn(|| life.live(TICKS, false));
        let two = scope.spawn(|| life.live(TICKS, true));
        (one.join().unwrap(), two.join().unwrap())
    });
    assert_eq!(one.len(), 100);
    for (index, (one, two)) in one.iter().zip(&two).enumerate() {
        assert_eq!(one, two, "after {} ticks", (index + 1) * 1_000);
    }
    let short = life.live(10_000, false);
    assert_eq!(short[..], one[..10]);
    let different = one.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(different, 99);
}

#[test]
fn a_state_of_another_kind_is_refused_and_changes_nothing() {
    let mut giant = creature(&kind(&brain_file()), CreatureConfig::default());
    let other = kind(&support::brain_with("a", r#"{ "a": {}, "b": {} }"#));
    let foreign = creature(&other, CreatureConfig::default()).state().clone();
    let before = giant.state().clone();
    assert!(giant.restore(foreign).is_err());
    assert_eq!(giant.state(), &before);
}

/// A saved state with a changed number is either refused, or restored and then stepped without an error.
#[test]
fn a_forged_state_is_refused_or_steps() {
    let kind = support::kind(&support::brain_file());
    let terrain = level_ground();
    let around = on_terrain(&terrain);
    let mut giant = support::creature(&kind, CreatureConfig::default());
    for _ in 0..200 {
        giant.step(&around).unwrap();
    }
    let quiet = giant.clone();
    // The second creature is in the middle of a fade.
    assert!(giant.enter("swipe_left"));
    for _ in 0..6 {
        giant.step(&around).unwrap();
    }
    assert!(giant.state().animator().is_fading());
    let saved = [&quiet, &giant].map(|giant| serde_json::to_value(giant.state()).unwrap());
    let (mut refused, mut stepped) = ([0; 2], [0; 2]);
    for (which, giant) in [&quiet, &giant].into_iter().enumerate() {
        let saved = &saved[which];
        let mut places = Vec::new();
        numbers(saved, String::new(), &mut places);
        for (index, place) in places.iter().enumerate() {
            // A pose has many numbers, so only some of them are changed.
            let many = ["/pose", "/clips/animator/offsets"]
                .iter()
                .any(|many| place.starts_with(many));
            if many && index % 47 != 0 || which == 1 && !place.starts_with("/clips/animator") {
                continue;
            }
            for value in [-1.0, 0.0, 1e3, 1e9, 1e30, 1e300, f64::MAX, f64::MIN] {
                let mut forged = saved.clone();
                *forged.pointer_mut(place).unwrap() = match value {
                    value if value.abs() < 1e10 => serde_json::json!(value as i64),
                    value => serde_json::json!(value),
                };
                let Ok(state) = serde_json::from_value::<CreatureState>(forged) else {
                    continue;
                };
                let mut other = giant.clone();
                if other.restore(state).is_err() {
                    refused[which] += 1;
                    assert_eq!(
                        other.state(),
                        giant.state(),
                        "{place} {value}: it was changed"
                    );
                    continue;
                }
                for tick in 0..3 {
                    let report = other.step(&around);
                    assert!(report.is_ok(), "{place} {value}, tick {tick}: {report:?}");
                }
                stepped[which] += 1;
            }
        }
    }
    println!("{refused:?} refused, {stepped:?} stepped");
    assert!(refused[0] > 100 && stepped[0] > 500);
    assert!(refused[1] > 20 && stepped[1] > 20);
}

/// The JSON pointers of all numbers in a value.
fn numbers(value: &serde_json::Value, at: String, places: &mut Vec<String>) {
    match value {
        serde_json::Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                numbers(item, format!("{at}/{index}"), places);
            }
        }
        serde_json::Value::Object(members) => {
            for (name, member) in members {
                numbers(member, format!("{at}/{name}"), places);
            }
        }
        serde_json::Value::Number(_) => places.push(at),
        _ => {}
    }
}
