//! Where one act ends and another one begins: what of the one may not go on in the other.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use clamber_animation::rig::Palette;
use clamber_colossus::{
    Creature, CreatureConfig, CreatureEvent, Foresight, Person, Riding, Sense, Surroundings,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::TriangleId;
use clamber_world::{HalfSpace, MaterialPoint, Obstacle};
use glam::{DQuat, DVec3};
use serde_json::Value;

use crate::carried::Deck;
use crate::support::{TICK, brain_with, creature, kind, kind_at, person};

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

/// How tall the giant is, metres, how long a tick is, seconds, and whether it stands on a ship that sails and turns.
#[derive(Clone, Copy, Debug)]
struct Setting {
    height: f64,
    tick: f64,
    sails: bool,
}

const SETTINGS: [Setting; 4] = [
    Setting {
        height: 41.0,
        tick: TICK,
        sails: false,
    },
    Setting {
        height: 4.0,
        tick: TICK,
        sails: false,
    },
    Setting {
        height: 150.0,
        tick: 1.0 / 30.0,
        sails: false,
    },
    Setting {
        height: 41.0,
        tick: 1.0 / 90.0,
        sails: true,
    },
];

/// A giant and the ground under it. Lengths and times are given as for one of 41 m, and places as on the ground.
struct Life {
    setting: Setting,
    one: Creature,
    deck: Deck,
    time: f64,
}

impl Life {
    fn new(setting: Setting) -> Self {
        let mut file: Value = serde_json::from_str(&brain_with("stands", STATES)).unwrap();
        file["body"]["height"] = setting.height.into();
        file["body"]["made_for"] = 41.0.into();
        Self {
            setting,
            one: creature(
                &kind_at(&file.to_string(), setting.tick),
                CreatureConfig::default(),
            ),
            deck: Deck {
                before: Similarity::IDENTITY,
                now: Similarity::IDENTITY,
            },
            time: 0.0,
        }
    }

    /// How much larger it is, and how much slower.
    fn scale(&self) -> [f64; 2] {
        let scale = self.setting.height / 41.0;
        [scale, scale.sqrt()]
    }

    fn angle(&self) -> f64 {
        if self.setting.sails {
            0.05 * self.time
        } else {
            0.0
        }
    }

    /// How it is turned on the ground.
    fn yaw(&self) -> f64 {
        self.one.state().yaw() - self.angle()
    }

    /// Radians a second, as for one of 41 m.
    fn yaw_rate(&self) -> f64 {
        self.number("/yaw_rate") * self.scale()[1]
    }

    fn number(&self, place: &str) -> f64 {
        let state = serde_json::to_value(self.one.state()).unwrap();
        state.pointer(place).and_then(Value::as_f64).unwrap()
    }

    /// A place on the ground, where it is now.
    fn place(&self, place: DVec3) -> DVec3 {
        self.deck.now.transform_point(place * self.scale()[0])
    }

    /// Lets some seconds pass, and calls a function after each tick.
    fn live(&mut self, people: &[Guest], seconds: f64, look: impl FnMut(&Self)) {
        let ticks = (seconds * self.scale()[1] / self.setting.tick).round() as u32;
        self.ticks(people, ticks, look);
    }

    fn ticks(&mut self, people: &[Guest], ticks: u32, mut look: impl FnMut(&Self)) {
        for _ in 0..ticks {
            self.time += self.setting.tick;
            let angle = self.angle();
            let moved =
                DVec3::new(4.0, 0.0, 1.0) * if self.setting.sails { self.time } else { 0.0 };
            self.deck.before = self.deck.now;
            self.deck.now = Similarity {
                translation: moved,
                rotation: DQuat::from_rotation_y(angle),
                scale: 1.0,
            };
            let people: Vec<Person> = people
                .iter()
                .map(|guest| Person {
                    id: guest.id,
                    riding: guest.riding,
                    ..person(self.place(guest.place))
                })
                .collect();
            let terrain: [&dyn Obstacle; 1] = [&self.deck];
            let around = Surroundings {
                terrain: &terrain,
                people: &people,
                ..Surroundings::default()
            };
            self.one.step(&around).unwrap();
            look(self);
        }
    }

    /// Lets it turn on and on, after somebody who goes round it.
    fn turn(&mut self, side: f64, seconds: f64) {
        let ticks = (seconds * self.scale()[1] / self.setting.tick).round() as u32;
        for _ in 0..ticks {
            let prey = at(self.yaw() + side * 1.4, 40.0);
            self.ticks(&[prey], 1, |_| {});
        }
    }
}

/// Somebody near it, by the place on the ground.
#[derive(Clone, Copy)]
struct Guest {
    id: u64,
    place: DVec3,
    riding: Option<Riding>,
}

fn at(angle: f64, far: f64) -> Guest {
    Guest {
        id: 1,
        place: DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * far,
        riding: None,
    }
}

fn giant() -> Creature {
    creature(
        &kind(&brain_with("stands", STATES)),
        CreatureConfig::default(),
    )
}

/// Lets some seconds pass on level ground.
fn live(one: &mut Creature, seconds: f64) {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    for _ in 0..(seconds / TICK).round() as u32 {
        let around = Surroundings {
            terrain: &terrain,
            ..Surroundings::default()
        };
        one.step(&around).unwrap();
    }
}

/// It comes to rest before it sleeps: its turn, its head, its feet.
#[test]
fn who_falls_asleep_comes_to_rest_first() {
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
        let mut life = Life::new(setting);
        let people = [at(angle, 40.0)];
        assert!(life.one.enter(before));
        if before == "turns" {
            life.turn(angle.signum(), 4.0);
        } else {
            life.live(&people, 4.0, |_| {});
        }
        assert!(life.yaw_rate().abs() > 0.2 || before != "turns");
        assert!(life.one.enter("dozes"));
        let dt = setting.tick / life.scale()[1];
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
        // What the gait's own turns change by.
        assert!(worst < 0.3, "{setting:?}, {before}: {worst}");
        assert_eq!(life.yaw_rate(), 0.0, "{setting:?}, {before}");
        assert!(
            life.number("/gaze_weight/value") < 0.02,
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

/// Who sleeps is not foreseen to move, and begins to move from rest when it wakes.
#[test]
fn who_sleeps_is_still_until_it_wakes() {
    for setting in SETTINGS {
        let mut life = Life::new(setting);
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
        // In the middle of a swipe.
        let mut life = Life::new(setting);
        assert!(life.one.enter("swipes"));
        life.live(&[], 0.9, |_| {});
        assert!(life.one.enter("dozes"));
        life.live(&[], 12.0, |_| {});
        let hand = life.one.kind().skeleton().find("hand.R").unwrap();
        let place = |life: &Life| {
            life.one
                .palette()
                .model_from_joint(hand)
                .unwrap()
                .translation
        };
        assert!(life.one.enter("idles"));
        let last = place(&life);
        let mut moved = 0f64;
        life.ticks(&[], 1, |life| moved = (place(life) - last).length());
        let fastest = moved / (setting.tick / life.scale()[1]);
        println!("{setting:?}: the hand begins with {fastest:.3} m/s");
        assert!(fastest < 1.0, "{setting:?}: {fastest}");
    }
}

/// An attack aims at where somebody is, and that has to be where it strikes: it does not turn on meanwhile.
#[test]
fn who_attacks_has_ended_its_turn() {
    for setting in SETTINGS {
        for (seconds, side) in [(1.0, 1.0), (2.0, -1.0), (3.0, 1.0), (4.0, -1.0)] {
            let mut life = Life::new(setting);
            assert!(life.one.enter("turns"));
            life.turn(side, seconds);
            assert!(life.yaw_rate().abs() > 0.05);
            let yaw = life.yaw();
            let mut from: Option<f64> = None;
            // Not by an order, which interrupts.
            let mut state: Value = serde_json::to_value(life.one.state()).unwrap();
            let stomps = life.one.kind().brain().find("stomps").unwrap();
            state["brain"]["current"] = serde_json::to_value(stomps).unwrap();
            state["acting"] = Value::Null;
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

/// Who wakes does not see where somebody was before it slept.
#[test]
fn who_wakes_has_to_look_first() {
    for setting in SETTINGS {
        let mut life = Life::new(setting);
        life.live(&[at(0.1, 30.0)], 3.0, |_| {});
        assert!(life.number("/unseen") < 1.0, "{setting:?}");
        assert!(life.one.enter("dozes"));
        life.live(&[], 12.0, |_| {});
        assert!(life.number("/unseen") > 100.0, "{setting:?}");
    }
}

/// When the nearest person gets on it, the next one is in view at once.
#[test]
fn another_person_is_seen_at_once() {
    for setting in SETTINGS {
        for ticks in 0..8 {
            let mut life = Life::new(setting);
            let (near, mut far) = (at(0.1, 25.0), at(-0.2, 30.0));
            far.id = 2;
            life.live(&[near, far], 1.0, |_| {});
            life.ticks(&[near, far], ticks, |_| {});
            let mut rides = near;
            rides.riding = Some(Riding {
                at: MaterialPoint::on_triangle(TriangleId(0), [1.0 / 3.0; 3]),
                hangs: false,
            });
            life.ticks(&[rides, far], 6, |life| {
                let seen = life.one.state().senses().get(Sense::PreySeen);
                assert_eq!(seen, 1.0, "{setting:?}, {ticks}");
            });
        }
    }
}

/// What turns to the right never plays the turn to the left, however fast it walked before.
#[test]
fn a_turn_is_played_to_its_own_side() {
    for setting in SETTINGS {
        for (side, other) in [(-1.0, "turn_left"), (1.0, "turn_right")] {
            let mut life = Life::new(setting);
            let speed = |life: &Life| life.one.state().speed() / life.scale()[1];
            assert!(life.one.enter("walks"));
            for _ in 0..1200 {
                if speed(&life) < 3.0 {
                    life.ticks(&[], 1, |_| {});
                }
            }
            let mut prey = at(life.yaw() + side * 1.3, 40.0);
            let place = life
                .deck
                .now
                .inverse_transform_point(life.one.state().position());
            prey.place += place / life.scale()[0];
            life.live(&[prey], 0.2, |_| {});
            assert!(speed(&life) > 2.0);
            assert!(life.one.enter("turns"));
            let wrong = life.one.kind().clips().find(other).unwrap();
            life.live(&[prey], 4.0, |life| {
                let clip = life.one.state().animator().layers()[0].clip;
                assert_ne!(clip, wrong, "{setting:?}, {side}");
            });
        }
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
    live(&mut one, 1.0);
    let state = one.state().carry_over(&old, &new).unwrap();
    let mut one = creature(&new, CreatureConfig::default());
    one.restore(state).unwrap();
    live(&mut one, 5.0);
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

/// No event tells of a damage of 0.
#[test]
fn no_damage_is_no_hurt() {
    let mut one = giant();
    live(&mut one, 0.1);
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
