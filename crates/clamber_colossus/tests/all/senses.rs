//! The giant's senses: the events that it notices, and how soon. Scenes B41 and B42.

use crate::support;

use std::sync::Arc;

use crate::support::{
    TICK, add_block, brain_file, creature, ground, kind, level_ground, on_terrain, terrain_of,
    with_noises, with_people,
};
use clamber_colossus::{
    Creature, CreatureConfig, CreatureEvent, CreatureKind, Noise, Person, Riding, Sense,
    Surroundings,
};
use clamber_surface::mesh::TriangleId;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

fn person(at: DVec3, riding: Option<Riding>) -> Person {
    Person {
        riding,
        ..support::person(at)
    }
}

/// A point of the skin that moves with a joint.
fn skin_of(kind: &CreatureKind, joint: &str) -> MaterialPoint {
    let joint = kind.skeleton().find(joint).unwrap();
    let mesh = kind.mesh();
    let all = (0..mesh.triangles().len() as u32).map(TriangleId);
    let triangle = all
        .into_iter()
        .find(|triangle| mesh.joint_of(*triangle) == Some(joint));
    MaterialPoint::on_triangle(triangle.unwrap(), [1.0 / 3.0; 3])
}

/// Where a person stands on the chest.
fn on_chest(kind: &CreatureKind) -> Riding {
    Riding {
        at: skin_of(kind, "chest"),
        hangs: false,
    }
}

/// The states that are entered within some seconds: the time of each, seconds, and its path.
fn entered(giant: &mut Creature, around: &Surroundings<'_>, seconds: f64) -> Vec<(f64, String)> {
    let mut found = Vec::new();
    for tick in 0..(seconds / TICK) as usize {
        for event in giant.step(around).unwrap().events.clone() {
            if let CreatureEvent::Entered { to, .. } = event {
                let path = giant.kind().brain().path(to).to_owned();
                found.push((tick as f64 * TICK, path));
            }
        }
    }
    found
}

fn alone(kind: &Arc<CreatureKind>, seed: u64) -> Creature {
    let config = CreatureConfig {
        seed,
        ..CreatureConfig::default()
    };
    creature(kind, config)
}

#[test]
fn an_arrow_alarms_it_within_half_a_second() {
    let kind = kind(&brain_file());
    let terrain = level_ground();
    let around = on_terrain(&terrain);
    let mut giant = alone(&kind, 1);
    entered(&mut giant, &around, 2.0);
    let chest = skin_of(&kind, "chest");
    assert_eq!(giant.hurt(&chest, DVec3::Y * 20.0, 0.0), 0.0);
    let states = entered(&mut giant, &around, 0.5);
    assert!(
        states.iter().any(|(_, name)| name == "alive/alert/notice"),
        "{states:?}"
    );
    // The alarm fades in its time, within two ticks.
    let moods: Vec<&str> = kind.brain().moods().collect();
    let alarm = moods.iter().position(|name| *name == "alarm").unwrap();
    let fades = kind.brain().file().moods["alarm"].fades;
    let left = fades - 0.5;
    entered(&mut giant, &around, left - 2.0 * TICK);
    assert!(giant.state().brain().mood(kind.brain(), alarm) > 0.0);
    entered(&mut giant, &around, 4.0 * TICK);
    assert_eq!(giant.state().brain().mood(kind.brain(), alarm), 0.0);
}

#[test]
fn what_terrain_hides_is_not_seen() {
    let kind = kind(&brain_file());
    let people = [person(DVec3::new(0.0, 0.0, 45.0), None)];
    for hidden in [false, true] {
        let mut world = ground(|_, _| 0.0);
        if hidden {
            let half = DVec3::new(40.0, 40.0, 1.0);
            add_block(&mut world, DVec3::Z * 40.0, half);
        }
        let terrain = terrain_of(&world);
        let terrain: [&dyn Obstacle; 1] = [&terrain];
        let around = with_people(&terrain, &people);
        let mut giant = alone(&kind, 1);
        entered(&mut giant, &around, 0.2);
        assert_eq!(
            giant.state().senses().get(Sense::PreySeen),
            f64::from(u8::from(!hidden))
        );
    }
}

#[test]
fn a_rider_is_noticed_and_shaken_with_rests() {
    let kind = kind(&brain_file());
    let terrain = level_ground();
    let riding = on_chest(&kind);
    let people = [person(DVec3::Y * 30.0, Some(riding))];
    let around = with_people(&terrain, &people);
    let shakes = ["shrug", "shake", "rage", "rub_left", "rub_right"];
    let is_shake = |name: &str| {
        let name = name.rsplit('/').next().unwrap();
        shakes.contains(&name) || name.starts_with("shake_")
    };
    let mut firsts = Vec::new();
    for seed in 0..20 {
        let mut giant = alone(&kind, seed);
        let states = entered(&mut giant, &around, 60.0);
        let noticed = states
            .iter()
            .find(|(_, name)| name.starts_with("alive/ridden"))
            .unwrap()
            .0;
        assert!(noticed <= 1.0, "noticed after {noticed} s");
        let first = states.iter().find(|(_, name)| is_shake(name)).unwrap().0;
        assert!(
            (1.9..=6.1).contains(&(first - noticed)),
            "first shake after {first} s"
        );
        firsts.push((first * 10.0) as i64);
        // A rest is the time from the end of a shake to the next one.
        let mut ended: Option<f64> = None;
        for (time, name) in &states {
            if is_shake(name) {
                if let Some(ended) = ended {
                    assert!(time - ended >= 3.0, "a rest of {} s only", time - ended);
                }
                ended = None;
            } else if ended.is_none() {
                ended = Some(*time).filter(|time| *time > first);
            }
        }
    }
    firsts.sort_unstable();
    firsts.dedup();
    assert!(firsts.len() > 10, "{firsts:?}");
}

/// A noise has its full loudness up to the distance `hearing`. Beyond, it falls off with the square of the distance.
#[test]
fn noises_fall_off_with_distance() {
    let states = r#"{ "waits": {} }"#;
    let kind = support::kind(&support::brain_with("waits", states));
    let terrain = level_ground();
    let heard = |hearing: f64, noises: &[Noise]| {
        let config = CreatureConfig {
            hearing,
            ..CreatureConfig::default()
        };
        let mut giant = support::creature(&kind, config);
        giant.step(&with_noises(&terrain, noises)).unwrap();
        giant.state().senses().get(Sense::Noise)
    };
    let eye = support::creature(&kind, CreatureConfig::default());
    let head = kind.eye();
    let at = |distance: f64| Noise {
        place: eye.state().position() + head + DVec3::X * distance,
        loudness: 2.0,
    };
    for (distance, loudness) in [(10.0, 2.0), (49.0, 2.0), (100.0, 0.5), (1e5, 2.0 * 0.25e-6)] {
        let found = heard(50.0, &[at(distance)]);
        let off = (found / loudness - 1.0).abs();
        assert!(off < 0.05, "{distance} m: {found}");
    }
    assert_eq!(heard(f64::INFINITY, &[at(1e5)]), 2.0);
    assert_eq!(heard(0.0, &[at(20.0)]), 0.0);
    // The noise that is loudest at the creature counts, not the one that is loudest at its source.
    let far = Noise {
        loudness: 5.0,
        ..at(500.0)
    };
    let found = heard(50.0, &[far, at(20.0)]);
    assert_eq!(found, 2.0);
    let nowhere = Noise {
        place: DVec3::NAN,
        loudness: 9.0,
    };
    assert_eq!(heard(50.0, &[nowhere]), 0.0);
}

/// A person that leaves or dies stops being a rider at once. A rider that hops stays one.
#[test]
fn who_is_gone_rides_no_longer() {
    let kind = kind(&brain_file());
    let terrain = level_ground();
    let riding = on_chest(&kind);
    let at = DVec3::Y * 30.0;
    for (after, riders) in [(vec![], 0.0), (vec![person(at, None)], 1.0)] {
        let mut giant = alone(&kind, 1);
        let mut step = |people: &[Person]| {
            giant.step(&with_people(&terrain, people)).unwrap();
            let senses = giant.state().senses();
            [senses.get(Sense::Riders), senses.get(Sense::RiderSeconds)]
        };
        for _ in 0..60 {
            step(&[person(at, Some(riding))]);
        }
        let [now, seconds] = step(&after);
        assert_eq!(now, riders);
        assert_eq!(seconds > 0.9, riders > 0.0, "{seconds}");
    }
}

/// Only riders that hang count: not those that stand or grip, and not those that hang elsewhere.
#[test]
fn riders_that_hang_are_counted_among_the_riders() {
    let kind = kind(&brain_file());
    let terrain = level_ground();
    let at = DVec3::Y * 30.0;
    let rider = |id: u64, hangs: bool| Person {
        id,
        riding: Some(Riding {
            hangs,
            ..on_chest(&kind)
        }),
        ..support::person(at)
    };
    let beside = Person {
        id: 9,
        ..person(at, None)
    };
    for hangs in [
        vec![],
        vec![false],
        vec![true],
        vec![false, true, true],
        vec![true, true, false, false, true],
    ] {
        let riders = (0..).zip(&hangs).map(|(id, hangs)| rider(id, *hangs));
        let people: Vec<Person> = riders.chain([beside]).collect();
        let mut giant = alone(&kind, 1);
        giant.step(&with_people(&terrain, &people)).unwrap();
        let senses = giant.state().senses();
        let found = [Sense::Riders, Sense::RidersHanging].map(|sense| senses.get(sense));
        let hanging = hangs.iter().filter(|hangs| **hangs).count();
        assert_eq!(found, [hangs.len() as f64, hanging as f64], "{hangs:?}");
        // A rider that takes hold again, or is gone, hangs no longer.
        giant
            .step(&with_people(&terrain, &[rider(0, false)]))
            .unwrap();
        let after = giant.state().senses().get(Sense::RidersHanging);
        assert_eq!(after, 0.0, "{hangs:?}");
    }
}
