//! What a game makes a creature do: to be put somewhere, to go somewhere, to be in a state, to be hurt.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, CreatureKind, Surroundings};
use clamber_surface::mesh::TriangleId;
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, Pose};
use clamber_world::{BodyPoses, HalfSpace, MaterialPoint, Obstacle, RapierTerrain};
use glam::DVec3;

use crate::support::{TICK, brain_file, creature, kind as giant};
use crate::walls::creatures;

fn level(a: DVec3, b: DVec3) -> f64 {
    (a - b).with_y(0.0).length()
}

/// Steps a creature until it says that it arrived or stopped, or for so many ticks. Returns that event and the ticks.
fn go(one: &mut Creature, terrain: &dyn Obstacle, most: u32) -> (Option<CreatureEvent>, u32) {
    let terrain = [terrain];
    let around = Surroundings {
        terrain: &terrain,
        ..Surroundings::default()
    };
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

/// The giant in its own brain's state, and animals, at their heights.
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
            // In the middle of what it does.
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
            // Its own act goes on.
            go(&mut one, &ground, 60);
            assert_ne!(one.state().ticks(), 0);
        }
    }
}

/// A state that interrupts does not make it glide on its way: its clip of walking goes on.
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

/// Who sleeps and is put on other ground lies there as whoever began there, at any height above it.
#[test]
fn put_asleep_it_lies_on_its_new_ground() {
    let ground = HalfSpace::below(3.0);
    let kind = giant(&brain_file());
    let mut began = creature(&kind, at(DVec3::new(40.0, 5.0, 0.0), 1.0));
    let mut one = creature(&kind, at(DVec3::ZERO, 0.0));
    go(&mut one, &HalfSpace::below(0.0), 600);
    // Turned round many times: its heading is kept small.
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
    let floor = ColliderBuilder::cuboid(400.0, 1.0, 400.0);
    world.insert_collider(floor.position(Pose::translation(0.0, -1.0, 0.0)), None);
    let wall = ColliderBuilder::cuboid(30.0, 30.0, 4.0);
    world.insert_collider(wall.position(Pose::translation(0.0, 30.0, 60.0)), None);
    let rock = ColliderBuilder::cuboid(60.0, 30.0, 60.0);
    world.insert_collider(rock.position(Pose::translation(200.0, 30.0, 0.0)), None);
    world.detect_collisions(&(), &());
    let poses = BodyPoses::new();
    let terrain = RapierTerrain::of_world(&world, &poses);
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
        // A noise that was never heard is remembered where it began: that alone differs.
        let position = |one: &Creature| (one.state().position(), one.state().current());
        assert_eq!(position(&began), position(&one), "{name}");
        let palette = |one: &Creature| one.palette().matrices().to_vec();
        assert!(palette(&began) == palette(&one), "{name}");
        // In the middle of something.
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
        let around = Surroundings {
            terrain: &terrain,
            ..Surroundings::default()
        };
        let events = one.step(&around).unwrap().events.clone();
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
