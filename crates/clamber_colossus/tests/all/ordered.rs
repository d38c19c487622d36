//! Orders of a game to a creature: to be put somewhere, to go somewhere, to enter a state, and to be hurt.

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, CreatureKind};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::TargetMotion;
use clamber_world::rapier3d::prelude::PhysicsWorld;
use clamber_world::{
    Contact, HalfSpace, MaterialPoint, Obstacle, PointMotion, RapierTerrain, SweepContact,
    WorldCapsule,
};
use glam::DVec3;

use crate::carried::Deck;
use crate::support::{
    TICK, add_block, brain_file, brain_with, creature, kind as giant, level_ground, on_terrain,
    person, terrain_of, with_people,
};
use crate::walls::creatures;

fn level(a: DVec3, b: DVec3) -> f64 {
    (a - b).with_y(0.0).length()
}

/// Steps a creature until it arrives or stops, for at most `most` ticks. Returns the event and the number of ticks.
fn go(one: &mut Creature, terrain: &dyn Obstacle, most: u32) -> (Option<CreatureEvent>, u32) {
    let terrain = [terrain];
    let around = on_terrain(&terrain);
    for tick in 0..most {
        let report = one.step(&around).unwrap();
        let end = report.events.iter().find(|event| {
            matches!(
                event,
                CreatureEvent::Arrived { .. } | CreatureEvent::Stopped { .. }
            )
        });
        if let Some(event) = end {
            return (Some(event.clone()), tick);
        }
    }
    (None, most)
}

/// The giant with its own brain, and animals that go to noises, each with its height.
fn walkers() -> Vec<(&'static str, Arc<CreatureKind>, f64)> {
    let mut all = creatures();
    all[0].1 = giant(&brain_file());
    all
}

fn at(place: DVec3, yaw: f64) -> CreatureConfig {
    CreatureConfig {
        position: place,
        yaw,
        ..CreatureConfig::default()
    }
}

#[test]
fn goes_where_it_is_sent_whatever_its_brain_wants() {
    let ground = HalfSpace::below(0.0);
    for (name, kind, height) in walkers() {
        for (angle, far) in [(0.3, 2.0), (2.5, 1.5), (-1.6, 4.0)] {
            let mut one = creature(&kind, at(DVec3::new(7.0, 0.0, -3.0), 0.4));
            // The order comes in the middle of the creature's own act.
            go(&mut one, &ground, 40);
            let (sin, cos) = libm::sincos(angle);
            let to = one.state().position() + DVec3::new(sin, 0.0, cos) * (far * height);
            assert!(one.send(Some(to)));
            assert_eq!(one.sent_to(), Some(to));
            let (end, ticks) = go(&mut one, &ground, 60 * 60);
            assert_eq!(end, Some(CreatureEvent::Arrived { place: to }), "{name}");
            let off = level(one.state().position(), to);
            assert!(
                off <= 0.1 * height,
                "{name}: {off} m off after {ticks} ticks"
            );
            assert_eq!(one.sent_to(), None);
            // After the errand, the creature's own act goes on.
            go(&mut one, &ground, 60);
            assert_ne!(one.state().ticks(), 0);
        }
    }
}

/// On an errand, a state that interrupts does not make the giant glide: its walking clip goes on.
#[test]
fn walks_on_when_its_brain_is_interrupted() {
    let ground = HalfSpace::below(0.0);
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    assert!(one.send(Some(DVec3::Z * 120.0)));
    go(&mut one, &ground, 240);
    let clip = one.state().animator().layers()[0].clip;
    let mut before = one.state().position().z;
    for _ in 0..5 {
        assert!(one.enter("roar"));
        go(&mut one, &ground, 30);
        let now = one.state().position().z;
        assert!(now - before > 1.0, "it stands");
        assert_eq!(one.state().animator().layers()[0].clip, clip, "it glides");
        before = now;
    }
}

/// A sleeping creature that is put on other ground lies there like one that began there, even if it is put above the
/// ground.
#[test]
fn put_asleep_it_lies_on_its_new_ground() {
    let ground = HalfSpace::below(3.0);
    let kind = giant(&brain_file());
    let mut began = creature(&kind, at(DVec3::new(40.0, 5.0, 0.0), 1.0));
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    go(&mut one, &HalfSpace::below(0.0), 600);
    // The yaw has 1000 extra full turns, which the creature removes.
    one.put(
        DVec3::new(40.0, 5.0, 0.0),
        1.0 + core::f64::consts::TAU * 1000.0,
    )
    .unwrap();
    go(&mut began, &ground, 300);
    go(&mut one, &ground, 300);
    let [a, b] = [&began, &one].map(|one| one.state().position());
    assert!(a.distance(b) < 0.01, "{a} {b}");
    assert!((a.y - 3.0).abs() < 0.2, "{a}");
}

#[test]
fn goes_beyond_its_arena_and_can_be_called_back() {
    let ground = HalfSpace::below(0.0);
    let kind = giant(&brain_file());
    let config = CreatureConfig {
        arena: 10.0,
        ..at(DVec3::ZERO, 0.0)
    };
    let mut one = creature(&kind, config);
    assert!(one.send(Some(DVec3::new(0.0, 0.0, 150.0))));
    let (end, _) = go(&mut one, &ground, 60 * 20);
    assert_eq!(end, None, "it is still on its way");
    assert!(one.state().position().z > 40.0);
    assert!(one.send(None));
    let (end, _) = go(&mut one, &ground, 60 * 8);
    assert_eq!((end, one.sent_to()), (None, None));
    assert_eq!(one.state().speed(), 0.0, "it sleeps, as its brain wants");
}

#[test]
fn goes_round_walls_and_says_where_it_cannot_go() {
    let mut world = PhysicsWorld::default();
    // A floor, a wall and a rock.
    for [at, half] in [
        [DVec3::NEG_Y, DVec3::new(400.0, 1.0, 400.0)],
        [DVec3::new(0.0, 30.0, 60.0), DVec3::new(30.0, 30.0, 4.0)],
        [DVec3::new(200.0, 30.0, 0.0), DVec3::new(60.0, 30.0, 60.0)],
    ] {
        add_block(&mut world, at, half);
    }
    let terrain = terrain_of(&world);
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    let behind = DVec3::new(0.0, 0.0, 130.0);
    assert!(one.send(Some(behind)));
    let (end, _) = go(&mut one, &terrain, 60 * 240);
    assert_eq!(end, Some(CreatureEvent::Arrived { place: behind }));
    let inside = DVec3::new(200.0, 0.0, 0.0);
    assert!(one.send(Some(inside)));
    let (end, _) = go(&mut one, &terrain, 60 * 400);
    assert_eq!(end, Some(CreatureEvent::Stopped { place: inside }));
    assert_eq!(one.sent_to(), None);
}

#[test]
fn an_errand_is_state() {
    let ground = HalfSpace::below(0.0);
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    go(&mut one, &ground, 10);
    assert!(one.send(Some(DVec3::new(60.0, 0.0, -40.0))));
    for _ in 0..6 {
        let saved = one.state().clone();
        let json = serde_json::to_string(&saved).unwrap();
        let mut other = creature(&kind, at(DVec3::ONE, 2.0));
        other.restore(serde_json::from_str(&json).unwrap()).unwrap();
        go(&mut one, &ground, 100);
        go(&mut other, &ground, 100);
        assert!(one.state() == other.state());
    }
}

#[test]
fn put_somewhere_it_lives_as_if_it_had_begun_there() {
    let ground = HalfSpace::below(0.0);
    for (name, kind, _) in walkers() {
        let (place, yaw) = (DVec3::new(40.0, 0.0, -20.0), 1.3);
        let mut began = creature(&kind, at(place, yaw));
        let mut one = creature(&kind, at(DVec3::new(-9.0, 0.0, 4.0), -2.0));
        one.put(place, yaw).unwrap();
        go(&mut began, &ground, 300);
        go(&mut one, &ground, 300);
        // The states differ in the remembered place of a noise alone, which starts at the place where the creature
        // began.
        let position = |one: &Creature| (one.state().position(), one.state().current());
        assert_eq!(position(&began), position(&one), "{name}");
        let palette = |one: &Creature| one.palette().matrices().to_vec();
        assert!(palette(&began) == palette(&one), "{name}");
        // The creature is put there again in the middle of an errand.
        one.send(Some(DVec3::ZERO));
        go(&mut one, &ground, 200);
        one.put(place, yaw).unwrap();
        let skin = one.surface();
        let point = MaterialPoint::on_triangle(TriangleId(7), [0.2, 0.3, 0.5]);
        let motion = Obstacle::motion(skin, &point, TICK).unwrap();
        assert_eq!(motion.velocity, DVec3::ZERO, "{name}: its skin moves");
        assert_eq!((one.state().position(), one.state().yaw()), (place, yaw));
        let before = one.state().clone();
        for place in [DVec3::NAN, DVec3::splat(f64::INFINITY), DVec3::X * 1e13] {
            assert!(one.put(place, 0.0).is_err());
            assert!(!one.send(Some(place)));
        }
        assert!(one.put(DVec3::ZERO, f64::NAN).is_err());
        assert!(*one.state() == before, "{name}: refused, and changed");
    }
}

#[test]
fn states_are_entered_by_name_and_weak_points_are_hurt_by_number() {
    let ground = HalfSpace::below(0.0);
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    for state in kind.brain().states() {
        let path = kind.brain().path(state).to_owned();
        let name = path.rsplit('/').next().unwrap();
        assert!(one.enter(name), "{path}");
        assert!(
            kind.brain().is_within(one.state().current(), state),
            "{path}"
        );
        let to = one.state().current();
        let terrain: [&dyn Obstacle; 1] = [&ground];
        let events = one.step(&on_terrain(&terrain)).unwrap().events.clone();
        let enters = |event: &CreatureEvent| matches!(event, CreatureEvent::Entered { to: into, .. } if *into == to);
        assert!(events.iter().any(enters), "{path}");
    }
    let before = one.state().clone();
    assert!(!one.enter("nowhere"));
    assert_eq!(one.harm(99, 0.1), None);
    assert_eq!(one.harm(0, f64::NAN), None);
    assert_eq!(one.harm(0, -0.1), None);
    assert!(*one.state() == before);
    let full = one.state().hit_points()[0];
    assert_eq!(one.harm(0, 0.25 * full), Some(0.25 * full));
    assert_eq!(one.harm(0, 9.0 * full), Some(0.75 * full));
    assert_eq!(one.harm(0, 1.0), Some(0.0));
    assert_eq!(one.state().hit_points()[0], 0.0);
}

/// Calling back a creature that was not sent changes nothing: its act goes on, and it strikes as often as one that is
/// not called.
#[test]
fn calling_back_who_was_not_sent_changes_nothing() {
    let terrain = level_ground();
    let file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    let stomp = &file["states"]["alive"]["states"]["alert"]["states"]["stomp_right"]["act"];
    assert!(stomp["attack"].is_object(), "{stomp}");
    let states = serde_json::json!({ "strikes": { "act": stomp } });
    let kind = giant(&brain_with("strikes", &states.to_string()));
    let mut both = [0, 1].map(|_| creature(&kind, at(DVec3::ZERO, 0.0)));
    let mut blows = [0, 0];
    for tick in 0..400 {
        if tick == 100 {
            blows = [0, 0];
            both.iter_mut()
                .for_each(|one| assert!(one.enter("strikes")));
        }
        for (index, one) in both.iter_mut().enumerate() {
            if index == 1 {
                assert!(one.send(None));
            }
            blows[index] += one
                .step(&with_people(
                    &terrain,
                    &[person(DVec3::new(-3.0, 0.0, 6.0))],
                ))
                .unwrap()
                .blows
                .len();
        }
        assert_eq!(both[0].state(), both[1].state(), "tick {tick}");
    }
    assert_eq!(blows[0], blows[1]);
}

/// A giant that is sent to its goal anew in each tick reaches it, round a wall, even if the goal moves. The queries for
/// its way are at most about twice as many as for an errand that is given once.
#[test]
fn who_is_sent_in_each_tick_gets_there_and_looks_no_more_often() {
    let kind = giant(&brain_file());
    let mut asked = [0; 3];
    for (index, moves) in [None, Some(0.0), Some(0.01)].into_iter().enumerate() {
        let mut wall = PhysicsWorld::default();
        let half = DVec3::new(30.0, 25.0, 2.0);
        add_block(&mut wall, DVec3::new(0.0, 20.0, 45.0), half);
        let counting = Counting {
            ground: HalfSpace::below(0.0),
            wall: terrain_of(&wall),
            asked: std::sync::atomic::AtomicUsize::new(0),
        };
        let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
        let mut to = DVec3::new(0.0, 0.0, 110.0);
        assert!(one.send(Some(to)));
        let mut end = None;
        let mut ticks = 0;
        while end.is_none() && ticks < 60 * 120 {
            if let Some(moved) = moves {
                to.x += moved;
                assert!(one.send(Some(to)));
            }
            end = go(&mut one, &counting, 1).0;
            ticks += 1;
        }
        assert_eq!(end, Some(CreatureEvent::Arrived { place: to }), "{moves:?}");
        asked[index] = counting.asked.into_inner() / ticks as usize;
        println!("{moves:?}: {ticks} ticks, {} queries in each", asked[index]);
    }
    assert!(
        asked[1] <= asked[0] + asked[0] / 10 && asked[2] <= 2 * asked[0],
        "{asked:?}"
    );
}

/// Level ground and a wall that count their queries.
struct Counting<'a> {
    ground: HalfSpace,
    wall: RapierTerrain<'a>,
    asked: std::sync::atomic::AtomicUsize,
}

impl Counting<'_> {
    fn all(&self) -> [&dyn Obstacle; 2] {
        self.asked
            .fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        [&self.ground, &self.wall]
    }
}

impl Obstacle for Counting<'_> {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.all()
            .into_iter()
            .for_each(|one| one.overlap_capsule(capsule, contacts));
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let hits = self.all().into_iter();
        let hits = hits.filter_map(|one| one.cast_capsule(capsule, displacements, target));
        hits.min_by(|a, b| a.fraction.total_cmp(&b.fraction))
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let hits = self.all().into_iter();
        let hits =
            hits.filter_map(|one| one.cast_capsule_where(capsule, displacements, target, counts));
        hits.min_by(|a, b| a.fraction.total_cmp(&b.fraction))
    }

    fn motion(&self, _: &MaterialPoint, _: f64) -> Option<PointMotion> {
        None
    }
}

#[test]
fn who_has_come_to_its_end_is_not_sent() {
    let kind = giant(&brain_with(
        "dead",
        r#"{ "dead": { "final": true }, "lives": {} }"#,
    ));
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    let before = one.state().clone();
    assert!(!one.send(Some(DVec3::Z * 50.0)));
    assert!(one.send(None));
    assert_eq!(one.state(), &before);
    assert!(one.enter("lives"));
    assert!(one.send(Some(DVec3::Z * 50.0)));
}

/// A creature that dies on an errand gives the errand up, whether its own brain or an order makes it die.
#[test]
fn who_dies_on_the_way_stays_there() {
    let states = r#"{
        "lives": { "transitions": [{ "to": "dead", "when": ["health <= 0"], "interrupts": true }] },
        "dead": { "final": true, "act": { "once": "die" } }
    }"#;
    let kind = giant(&brain_with("lives", states));
    let terrain = level_ground();
    let around = on_terrain(&terrain);
    for is_ordered in [false, true] {
        let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
        assert!(one.send(Some(DVec3::Z * 80.0)));
        for _ in 0..300 {
            one.step(&around).unwrap();
        }
        if is_ordered {
            assert!(one.enter("dead"));
        } else {
            let points = 0..one.kind().weak_points().len();
            points.for_each(|point| {
                one.harm(point, 1e9);
            });
        }
        let (mut stopped, from) = (0, one.state().position());
        for _ in 0..400 {
            let report = one.step(&around).unwrap();
            let is_end = |event: &&CreatureEvent| matches!(event, CreatureEvent::Stopped { .. });
            stopped += report.events.iter().filter(is_end).count();
        }
        assert_eq!((stopped, one.sent_to()), (1, None), "{is_ordered}");
        let way = level(one.state().position(), from);
        assert!(way < 8.0, "{is_ordered}: it went on for {way} m");
    }
}

/// A brain whose body has other weak points or legs, or no gait, keeps the hit points of weak points with the same
/// name.
#[test]
fn another_body_keeps_what_it_knows_by_name() {
    let mut file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    let point = |name: &str, hit_points: f64| serde_json::json!({ "name": name, "joint": "chest", "radius": 1.0, "hit_points": hit_points });
    file["body"]["weak_points"] =
        serde_json::json!([point("a", 10.0), point("b", 10.0), point("a", 20.0)]);
    let mut one = creature(&giant(&file.to_string()), at(DVec3::ZERO, 0.0));
    let ground = HalfSpace::below(0.0);
    go(&mut one, &ground, 30);
    // The weak points of the model's file come first.
    let first = one.state().hit_points().len() - 3;
    for (index, damage) in [(0, 4.0), (1, 1.0), (2, 7.0)] {
        assert_eq!(one.harm(first + index, damage), Some(damage));
    }
    assert!(one.send(Some(DVec3::Z * 50.0)));
    let changes: [(&str, serde_json::Value, &[f64]); 3] = [
        (
            "weak_points",
            serde_json::json!([
                point("c", 5.0),
                point("a", 10.0),
                point("b", 3.0),
                point("a", 20.0)
            ]),
            &[5.0, 6.0, 3.0, 13.0],
        ),
        ("legs", serde_json::json!([]), &[6.0, 9.0, 13.0]),
        ("gait", serde_json::Value::Null, &[6.0, 9.0, 13.0]),
    ];
    for (key, value, left) in changes {
        let mut file = file.clone();
        file["body"][key] = value;
        if key != "weak_points" {
            file["start"] = "stands".into();
            file["states"] = serde_json::json!({ "stands": {} });
        }
        let kind = giant(&file.to_string());
        let carried = one.state().carry_over(one.kind(), &kind);
        let Some(carried) = carried else {
            panic!("{key}")
        };
        let mut other = creature(&kind, at(DVec3::ZERO, 0.0));
        other
            .restore(carried)
            .unwrap_or_else(|error| panic!("{key}: {error}"));
        assert_eq!(&other.state().hit_points()[first..], left, "{key}");
        assert_eq!(other.sent_to().is_some(), key != "gait");
        go(&mut other, &ground, 30);
    }
}

/// Saved states with invalid hit points, wall distances, senses or turn rates are refused.
#[test]
fn forged_wounds_are_refused() {
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    go(&mut one, &HalfSpace::below(0.0), 5);
    one.harm(0, 0.1).unwrap();
    let saved = serde_json::to_value(one.state()).unwrap();
    let not = serde_json::json!(f64::NAN.to_bits());
    for (place, value) in [
        ("/damage/hit_points/0", serde_json::json!(-1.0)),
        ("/perceived/walls/0", serde_json::json!(-1.0)),
        ("/senses/numbers/3", not),
        ("/moving_ground/drift/yaw_rate", serde_json::json!(1e9)),
    ] {
        let mut forged = saved.clone();
        *forged
            .pointer_mut(place)
            .unwrap_or_else(|| panic!("{place}")) = value;
        let forged = serde_json::from_value(forged).unwrap();
        assert!(one.restore(forged).is_err(), "{place}");
    }
}

/// A giant that is put elsewhere in the middle of an attack keeps its aim relative to itself. It loses the velocity of
/// the ground that carried it.
#[test]
fn put_in_an_attack_it_aims_as_before() {
    let deck = |time: f64| Deck {
        before: Similarity::from_translation(DVec3::X * (3.0 * (time - TICK))),
        now: Similarity::from_translation(DVec3::X * (3.0 * time)),
    };
    let kind = giant(&brain_file());
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    for tick in 1..30 {
        go(&mut one, &deck(f64::from(tick) * TICK), 1);
    }
    let mut saved = serde_json::to_value(one.state()).unwrap();
    assert!(
        saved["moving_ground"]["drift"]["velocity"][0]
            .as_f64()
            .unwrap()
            > 2.9
    );
    saved["striking"]["aim"] = serde_json::json!([1.0, 0.5, 2.0]);
    one.restore(serde_json::from_value(saved).unwrap()).unwrap();
    let yaw = one.state().yaw();
    one.put(DVec3::X * 50.0, yaw + core::f64::consts::FRAC_PI_2)
        .unwrap();
    let saved = serde_json::to_value(one.state()).unwrap();
    let aim: Vec<f64> = serde_json::from_value(saved["striking"]["aim"].clone()).unwrap();
    for (found, expected) in aim.iter().zip([2.0, 0.5, -1.0]) {
        assert!((found - expected).abs() < 1e-9, "{aim:?}");
    }
    assert_eq!(
        saved["moving_ground"]["drift"]["velocity"],
        serde_json::json!([0.0, 0.0, 0.0])
    );
}
