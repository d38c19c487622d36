//! Where one act ends and another one begins: what of the one may not go on in the other.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use clamber_animation::rig::Palette;
use clamber_colossus::{
    Creature, CreatureConfig, CreatureEvent, Foresight, Person, Riding, Surroundings,
};
use clamber_world::{HalfSpace, MaterialPoint, Obstacle};
use glam::DVec3;
use serde_json::Value;

use crate::support::{TICK, brain_with, creature, kind, person};

const STATES: &str = r#"{
    "stands": {},
    "looks": { "gaze": "prey" },
    "turns": { "act": { "turn": { "to": "prey", "within_deg": 1 } } },
    "walks": { "act": { "walk": { "to": "patrol", "within": 1 } } },
    "swipes": { "act": { "play": "swipe" } },
    "idles": { "act": { "play": "idle" }, "fade": 1.6 },
    "dozes": { "act": "sleep" },
    "stomps": { "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"], "damage": 0.6, "throw": 9, "aim": 5 } } }
}"#;

fn giant() -> Creature {
    creature(
        &kind(&brain_with("stands", STATES)),
        CreatureConfig::default(),
    )
}

/// Lets some seconds pass on level ground, and calls a function after each tick.
fn live(one: &mut Creature, people: &[Person], seconds: f64, mut look: impl FnMut(&Creature)) {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    for _ in 0..(seconds / TICK).round() as u32 {
        let around = Surroundings {
            terrain: &terrain,
            people,
            ..Surroundings::default()
        };
        one.step(&around).unwrap();
        look(one);
    }
}

/// Lets it turn on and on, after somebody who goes round it.
fn turn(one: &mut Creature, side: f64, seconds: f64) {
    for _ in 0..(seconds / TICK) as u32 {
        let prey = at(one.state().yaw() + side * 1.4, 40.0);
        live(one, &[prey], TICK, |_| {});
    }
}

fn number(one: &Creature, place: &str) -> f64 {
    let state = serde_json::to_value(one.state()).unwrap();
    state.pointer(place).and_then(Value::as_f64).unwrap()
}

fn at(angle: f64, far: f64) -> Person {
    person(DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * far)
}

/// It comes to rest before it sleeps: its turn, its head, its feet.
#[test]
fn who_falls_asleep_comes_to_rest_first() {
    for (before, angle) in [
        ("turns", 1.4),
        ("turns", -1.4),
        ("looks", 1.0),
        ("walks", 0.0),
    ] {
        let mut one = giant();
        let people = [at(angle, 40.0)];
        assert!(one.enter(before));
        if before == "turns" {
            turn(&mut one, angle.signum(), 4.0);
        } else {
            live(&mut one, &people, 4.0, |_| {});
        }
        let is_turning = number(&one, "/yaw_rate").abs() > 0.2;
        assert!(is_turning || before != "turns");
        assert!(one.enter("dozes"));
        let (mut yaw, mut rate, mut worst) = (one.state().yaw(), 0.0, 0f64);
        let mut first = true;
        live(&mut one, &people, 30.0, |one| {
            let now = one.state().yaw();
            let turns = (now - yaw) / TICK;
            if !first {
                worst = worst.max((turns - rate).abs() / TICK);
            }
            (yaw, rate, first) = (now, turns, false);
        });
        println!("{before}: turns change by {worst:.3} rad/s^2");
        // What the gait's own turns change by.
        assert!(worst < 0.3, "{before}: {worst}");
        assert_eq!(number(&one, "/yaw_rate"), 0.0, "{before}");
        assert!(number(&one, "/gaze_weight/value") < 0.02, "{before}");
        assert!((0..2).all(|leg| one.state().is_planted(leg)), "{before}");
        assert!(
            one.state()
                .animator()
                .layers()
                .iter()
                .all(|layer| layer.speed == 0.0),
            "{before}"
        );
    }
}

/// Who sleeps is not foreseen to move, and begins to move from rest when it wakes.
#[test]
fn who_sleeps_is_still_until_it_wakes() {
    let mut one = giant();
    live(&mut one, &[], 2.0, |_| {});
    assert!(one.enter("dozes"));
    live(&mut one, &[], 12.0, |_| {});
    let palette = |seconds: f64| {
        let mut palette = Palette::default();
        one.foresee(seconds, &mut Foresight::default(), &mut palette)
            .unwrap();
        palette
    };
    assert_eq!(palette(0.0), palette(2.0));
    // In the middle of a swipe.
    let mut one = giant();
    assert!(one.enter("swipes"));
    live(&mut one, &[], 0.9, |_| {});
    assert!(one.enter("dozes"));
    live(&mut one, &[], 12.0, |_| {});
    let hand = one.kind().skeleton().find("hand.R").unwrap();
    let place = |one: &Creature| one.palette().model_from_joint(hand).unwrap().translation;
    assert!(one.enter("idles"));
    let mut last = place(&one);
    let mut fastest = 0f64;
    live(&mut one, &[], TICK, |one| {
        fastest = fastest.max((place(one) - last).length() / TICK);
        last = place(one);
    });
    println!("the hand begins with {fastest:.3} m/s");
    assert!(fastest < 1.0, "{fastest}");
}

/// An attack aims at where somebody is, and that has to be where it strikes: it does not turn on meanwhile.
#[test]
fn who_attacks_has_ended_its_turn() {
    for seconds in [1.0, 2.0, 3.0, 4.0] {
        for side in [-1.0, 1.0] {
            let mut one = giant();
            assert!(one.enter("turns"));
            turn(&mut one, side, seconds);
            assert!(number(&one, "/yaw_rate").abs() > 0.1);
            let yaw = one.state().yaw();
            let mut file: Option<f64> = None;
            // Not by an order, which interrupts.
            let mut state: Value = serde_json::to_value(one.state()).unwrap();
            let stomps = one.kind().brain().find("stomps").unwrap();
            state["brain"]["current"] = serde_json::to_value(stomps).unwrap();
            state["acting"] = Value::Null;
            one.restore(serde_json::from_value(state).unwrap()).unwrap();
            live(&mut one, &[at(yaw, 9.0)], 6.0, |one| {
                if one.attack().is_some() && file.is_none() {
                    file = Some(one.state().yaw());
                }
            });
            let turned = file.map(|from| (one.state().yaw() - from).abs());
            println!("after {seconds} s: turns by {turned:?} while it attacks");
            assert!(
                turned.is_some_and(|turned| turned < 0.03),
                "{seconds}: {turned:?}"
            );
        }
    }
}

/// Who wakes does not see where somebody was before it slept.
#[test]
fn who_wakes_has_to_look_first() {
    let mut one = giant();
    live(&mut one, &[at(0.1, 30.0)], 3.0, |_| {});
    assert!(number(&one, "/unseen") < 1.0);
    assert!(one.enter("dozes"));
    live(&mut one, &[], 12.0, |_| {});
    assert!(number(&one, "/unseen") > 100.0);
}

/// When the nearest person gets on it, the next one is in view at once.
#[test]
fn another_person_is_seen_at_once() {
    for ticks in 0..8 {
        let mut one = giant();
        let (near, mut far) = (at(0.1, 25.0), at(-0.2, 30.0));
        far.id = 2;
        live(
            &mut one,
            &[near, far],
            1.0 + f64::from(ticks) * TICK,
            |_| {},
        );
        let mut rides = near;
        rides.riding = Some(Riding {
            at: MaterialPoint::on_triangle(clamber_surface::mesh::TriangleId(0), [1.0 / 3.0; 3]),
            hangs: false,
        });
        live(&mut one, &[rides, far], 6.0 * TICK, |one| {
            assert_eq!(
                one.state().senses().get(clamber_colossus::Sense::PreySeen),
                1.0,
                "{ticks}"
            );
        });
    }
}

/// What turns to the right never plays the turn to the left, however fast it walked before.
#[test]
fn a_turn_is_played_to_its_own_side() {
    for (side, other) in [(-1.0, "turn_left"), (1.0, "turn_right")] {
        let mut one = giant();
        assert!(one.enter("walks"));
        for _ in 0..1200 {
            if one.state().speed() < 3.0 {
                live(&mut one, &[], TICK, |_| {});
            }
        }
        let angle = one.state().yaw() + side * 1.3;
        let mut prey = at(angle, 60.0);
        let by = one.state().position();
        prey.body.ends = prey.body.ends.map(|end| end + by);
        live(&mut one, &[prey], 0.2, |_| {});
        assert!(one.state().speed() > 2.0);
        assert!(one.enter("turns"));
        let wrong = one.kind().clips().find(other).unwrap();
        live(&mut one, &[prey], 4.0, |one| {
            assert_ne!(one.state().animator().layers()[0].clip, wrong, "{side}");
        });
    }
}

/// With a brain that does not have its act it stands as the new one says.
#[test]
fn what_the_new_brain_does_not_play_ends() {
    let old = kind(&brain_with(
        "stands",
        r#"{ "stands": {}, "plays": { "act": { "once": "roar" } } }"#,
    ));
    let new = kind(&brain_with("stands", r#"{ "stands": {} }"#));
    let mut one = creature(&old, CreatureConfig::default());
    assert!(one.enter("plays"));
    live(&mut one, &[], 1.0, |_| {});
    let state = one.state().carry_over(&old, &new).unwrap();
    let mut one = creature(&new, CreatureConfig::default());
    one.restore(state).unwrap();
    live(&mut one, &[], 5.0, |_| {});
    let idle = one.kind().clips().find("idle").unwrap();
    assert_eq!(one.state().animator().layers()[0].clip, idle);
}

/// States that are entered on an errand do not make it begin anew.
#[test]
fn an_errand_that_is_blocked_is_told_whatever_is_entered() {
    let poses = clamber_world::BodyPoses::default();
    let world = crate::undecided::pen();
    let terrain = clamber_world::RapierTerrain::of_world(&world, &poses);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let mut one = giant();
    assert!(one.send(Some(DVec3::new(-60.0, 0.0, 6.0))));
    let mut stopped = 0;
    for tick in 0..1200 {
        if tick % 30 == 0 {
            assert!(one.enter("stands"));
        }
        let report = one.step(&around).unwrap();
        let is_stopped = |event: &&CreatureEvent| matches!(event, CreatureEvent::Stopped { .. });
        stopped += report.events.iter().filter(is_stopped).count();
    }
    assert_eq!(stopped, 1);
}

/// A walk to within nothing ends.
#[test]
fn a_walk_to_a_point_ends() {
    let states = r#"{
        "stands": {},
        "goes": { "act": { "walk": { "to": "home", "within": 0 } }, "transitions": [{ "to": "there", "when": ["done"] }] },
        "there": {}
    }"#;
    let kind = kind(&brain_with("stands", states));
    for place in [
        DVec3::new(30.0, 0.0, 4.0),
        DVec3::new(-9.0, 0.0, 17.0),
        DVec3::Z * 41.0,
    ] {
        let mut one = creature(&kind, CreatureConfig::default());
        assert!(one.send(Some(place)));
        live(&mut one, &[], 60.0, |_| {});
        assert!(one.enter("goes"));
        live(&mut one, &[], 60.0, |_| {});
        let brain = one.kind().brain();
        assert_eq!(brain.path(one.state().current()), "there", "{place}");
        let left = one.state().position().with_y(0.0).length();
        println!("{left:.2} m from it");
        assert!(left < 0.02 * 41.0, "{left}");
    }
}

/// No event tells of a damage of 0.
#[test]
fn no_damage_is_no_hurt() {
    let mut one = giant();
    live(&mut one, &[], 0.1, |_| {});
    assert_eq!(one.harm(0, 0.0), Some(0.0));
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
    let report = one.step(&around).unwrap();
    let is_hurt = |event: &CreatureEvent| matches!(event, CreatureEvent::Hurt { .. });
    assert!(!report.events.iter().any(is_hurt));
}
