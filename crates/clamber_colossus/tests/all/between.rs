//! Transitions from one act to another: nothing of the old act may go on in the new one.

use clamber_animation::rig::Palette;
use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, Foresight, Sense};
use clamber_surface::mesh::TriangleId;
use clamber_world::{HalfSpace, Obstacle};
use glam::DVec3;
use serde_json::Value;

use crate::support::life::{Life, SETTINGS, Setting, at};
use crate::support::{
    TICK, brain_with, creature, kind, level_ground, on_terrain, rider, terrain_of,
};

/// The states that the tests enter, as JSON.
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

fn giant_in(setting: Setting, ground: &HalfSpace) -> Life<'_> {
    Life::new(setting, &brain_with("stands", STATES), ground)
}

fn giant() -> Creature {
    creature(
        &kind(&brain_with("stands", STATES)),
        CreatureConfig::default(),
    )
}

/// Lets some seconds pass on level ground.
fn live(one: &mut Creature, seconds: f64) {
    let terrain = level_ground();
    for _ in 0..(seconds / TICK).round() as u32 {
        one.step(&on_terrain(&terrain)).unwrap();
    }
}

/// Before the giant sleeps, its turn, its head and its feet come to rest.
#[test]
fn who_falls_asleep_comes_to_rest_first() {
    let ground = HalfSpace::below(0.0);
    let acts = [
        ("turns", 1.4),
        ("turns", -1.4),
        ("looks", 1.0),
        ("walks", 0.0),
    ];
    for (setting, (before, angle)) in SETTINGS
        .into_iter()
        .flat_map(|setting| acts.map(|act| (setting, act)))
    {
        let mut life = giant_in(setting, &ground);
        let people = [at(angle, 40.0)];
        assert!(life.one.enter(before));
        if before == "turns" {
            life.turn(angle.signum(), 4.0);
        } else {
            life.live(&people, 4.0, |_| {});
        }
        assert!(life.yaw_rate().abs() > 0.2 || before != "turns");
        assert!(life.one.enter("dozes"));
        let dt = setting.tick / setting.pace();
        let (mut yaw, mut rate, mut worst) = (life.yaw(), 0.0, 0f64);
        let mut first = true;
        life.live(&people, 30.0, |life| {
            let now = life.yaw();
            let turns = (now - yaw) / dt;
            if !first {
                worst = worst.max((turns - rate).abs() / dt);
            }
            (yaw, rate, first) = (now, turns, false);
        });
        println!("{setting:?}, {before}: turns change by {worst:.3} rad/s^2");
        // The limit is the largest change of the turn rate in the gait's own turns.
        assert!(worst < 0.3, "{setting:?}, {before}: {worst}");
        assert_eq!(life.yaw_rate(), 0.0, "{setting:?}, {before}");
        assert!(
            life.number("/head/weight/value") < 0.02,
            "{setting:?}, {before}"
        );
        let state = life.one.state();
        assert!(
            (0..2).all(|leg| state.is_planted(leg)),
            "{setting:?}, {before}"
        );
        let mut layers = state.animator().layers().iter();
        assert!(
            layers.all(|layer| layer.speed == 0.0),
            "{setting:?}, {before}"
        );
    }
}

/// A sleeping creature is foreseen to stay still. When it wakes, it starts to move from rest.
#[test]
fn who_sleeps_is_still_until_it_wakes() {
    let ground = HalfSpace::below(0.0);
    for setting in SETTINGS {
        let mut life = giant_in(setting, &ground);
        life.live(&[], 2.0, |_| {});
        assert!(life.one.enter("dozes"));
        life.live(&[], 12.0, |_| {});
        let palette = |seconds: f64| {
            let mut palette = Palette::default();
            life.one
                .foresee(seconds, &mut Foresight::default(), &mut palette)
                .unwrap();
            palette
        };
        assert_eq!(palette(0.0), palette(2.0), "{setting:?}");
        // The giant falls asleep in the middle of a swipe.
        let mut life = giant_in(setting, &ground);
        assert!(life.one.enter("swipes"));
        life.live(&[], 0.9, |_| {});
        assert!(life.one.enter("dozes"));
        life.live(&[], 12.0, |_| {});
        let hand = life.one.kind().skeleton().find("hand.R").unwrap();
        let place = |life: &Life<'_>| {
            life.one
                .palette()
                .model_from_joint(hand)
                .unwrap()
                .translation
        };
        assert!(life.one.enter("idles"));
        let last = place(&life);
        life.tick(&[]);
        let moved = (place(&life) - last).length();
        let fastest = moved / (setting.tick / setting.pace());
        println!("{setting:?}: the hand begins with {fastest:.3} m/s");
        assert!(fastest < 1.0, "{setting:?}: {fastest}");
    }
}

/// An attack strikes the place at which it has aimed, so the giant does not keep turning during it.
#[test]
fn who_attacks_has_ended_its_turn() {
    let ground = HalfSpace::below(0.0);
    for setting in SETTINGS {
        for (seconds, side) in [(1.0, 1.0), (2.0, -1.0), (3.0, 1.0), (4.0, -1.0)] {
            let mut life = giant_in(setting, &ground);
            assert!(life.one.enter("turns"));
            life.turn(side, seconds);
            assert!(life.yaw_rate().abs() > 0.05);
            let yaw = life.yaw();
            let mut from: Option<f64> = None;
            // The state is changed in the saved data, since the order `enter` interrupts the turn.
            let mut state: Value = serde_json::to_value(life.one.state()).unwrap();
            let stomps = life.one.kind().brain().find("stomps").unwrap();
            state["brain"]["current"] = serde_json::to_value(stomps).unwrap();
            state["acting"]["state"] = Value::Null;
            life.one
                .restore(serde_json::from_value(state).unwrap())
                .unwrap();
            life.live(&[at(yaw, 9.0)], 6.0, |life| {
                if life.one.attack().is_some() && from.is_none() {
                    from = Some(life.yaw());
                }
            });
            let turned = from.map(|from| (life.yaw() - from).abs());
            println!("{setting:?}, after {seconds} s: turns by {turned:?} while it attacks");
            assert!(
                turned.is_some_and(|turned| turned < 0.03),
                "{setting:?}, {seconds}: {turned:?}"
            );
        }
    }
}

/// A creature that has slept does not know where a person was before.
#[test]
fn who_wakes_has_to_look_first() {
    let ground = HalfSpace::below(0.0);
    for setting in SETTINGS {
        let mut life = giant_in(setting, &ground);
        life.live(&[at(0.1, 30.0)], 3.0, |_| {});
        assert!(life.number("/perceived/unseen") < 1.0, "{setting:?}");
        assert!(life.one.enter("dozes"));
        life.live(&[], 12.0, |_| {});
        assert!(life.number("/perceived/unseen") > 100.0, "{setting:?}");
    }
}

/// When the nearest person begins to ride the giant, the next one is in view at once.
#[test]
fn another_person_is_seen_at_once() {
    let ground = HalfSpace::below(0.0);
    for setting in SETTINGS {
        for ticks in 0..8 {
            let mut life = giant_in(setting, &ground);
            let (near, mut far) = (at(0.1, 25.0), at(-0.2, 30.0));
            far.id = 2;
            life.live(&[near, far], 1.0, |_| {});
            for _ in 0..ticks {
                life.tick(&[near, far]);
            }
            let mut rides = near;
            rides.riding = rider(DVec3::ZERO, TriangleId(0)).riding;
            for _ in 0..6 {
                life.tick(&[rides, far]);
                let seen = life.one.state().senses().get(Sense::PreySeen);
                assert_eq!(seen, 1.0, "{setting:?}, {ticks}");
            }
        }
    }
}

/// A turn to one side never plays the clip of a turn to the other side, however fast the giant walked before.
#[test]
fn a_turn_is_played_to_its_own_side() {
    let ground = HalfSpace::below(0.0);
    for setting in SETTINGS {
        for (side, other) in [(-1.0, "turn_left"), (1.0, "turn_right")] {
            let mut life = giant_in(setting, &ground);
            assert!(life.one.enter("walks"));
            for _ in 0..1200 {
                if life.speed() < 3.0 {
                    life.tick(&[]);
                }
            }
            let mut prey = at(life.yaw() + side * 1.3, 40.0);
            prey.place += life.position();
            life.live(&[prey], 0.2, |_| {});
            assert!(life.speed() > 2.0);
            assert!(life.one.enter("turns"));
            let wrong = life.one.kind().clips().find(other).unwrap();
            life.live(&[prey], 4.0, |life| {
                let clip = life.one.state().animator().layers()[0].clip;
                assert_ne!(clip, wrong, "{setting:?}, {side}");
            });
        }
    }
}

/// If the new brain lacks the current act, the creature stands, as the new brain says.
#[test]
fn what_the_new_brain_does_not_play_ends() {
    let old = kind(&brain_with(
        "stands",
        r#"{ "stands": {}, "plays": { "act": { "once": "roar" } } }"#,
    ));
    let new = kind(&brain_with("stands", r#"{ "stands": {} }"#));
    let mut one = creature(&old, CreatureConfig::default());
    assert!(one.enter("plays"));
    live(&mut one, 1.0);
    let state = one.state().carry_over(&old, &new).unwrap();
    let mut one = creature(&new, CreatureConfig::default());
    one.restore(state).unwrap();
    live(&mut one, 5.0);
    let idle = one.kind().clips().find("idle").unwrap();
    assert_eq!(one.state().animator().layers()[0].clip, idle);
}

/// An errand does not restart when states are entered during it.
#[test]
fn an_errand_that_is_blocked_is_told_whatever_is_entered() {
    let world = crate::undecided::pen(1.0);
    let terrain = terrain_of(&world);
    let terrain: [&dyn Obstacle; 1] = [&terrain];
    let around = on_terrain(&terrain);
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

/// A walk with `within` 0 ends.
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
        live(&mut one, 60.0);
        assert!(one.enter("goes"));
        live(&mut one, 60.0);
        let brain = one.kind().brain();
        assert_eq!(brain.path(one.state().current()), "there", "{place}");
        let left = one.state().position().with_y(0.0).length();
        println!("{left:.2} m from it");
        assert!(left < 0.02 * 41.0, "{left}");
    }
}

/// A damage of 0 reports no event.
#[test]
fn no_damage_is_no_hurt() {
    let mut one = giant();
    live(&mut one, 0.1);
    assert_eq!(one.harm(0, 0.0), Some(0.0));
    let terrain = level_ground();
    let report = one.step(&on_terrain(&terrain)).unwrap();
    let is_hurt = |event: &CreatureEvent| matches!(event, CreatureEvent::Hurt { .. });
    assert!(!report.events.iter().any(is_hurt));
}
