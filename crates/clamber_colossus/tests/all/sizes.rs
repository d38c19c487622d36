//! Sizes come from the skin posed at rest, and times from the size, for any unit of length in a file.

use crate::support;

use std::path::PathBuf;
use std::sync::Arc;

use crate::support::{TICK, brain_file, brain_with, level_ground, noise, person, with_noises};
use clamber_colossus::{Creature, CreatureConfig, CreatureKind, Surroundings};
use clamber_gltf::{LoadOptions, load_with};
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::mesh::Rig;
use clamber_surface::mesh::VertexId;
use glam::DVec3;

/// The giant, and the models of the test data that load.
pub(crate) fn models() -> Vec<PathBuf> {
    let mut all = vec![PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../assets/colossus.glb"
    ))];
    let Some(folder) = support::test_models("models") else {
        return all;
    };
    let folder = std::fs::read_dir(folder).unwrap();
    let files = folder.map(|entry| entry.unwrap().path());
    all.extend(files.filter(|path| {
        path.extension()
            .is_some_and(|end| end == "glb" || end == "gltf")
    }));
    all.sort();
    all
}

fn rig(path: &PathBuf, height: Option<f64>) -> Option<Rig> {
    let mut options = LoadOptions::default();
    options.height = height.map(|height| height as f32);
    Some(load_with(path, &options).ok()?.rig)
}

fn kind_of(rig: Rig, brain: &str) -> Arc<CreatureKind> {
    Arc::new(support::kind_of(&rig, brain).unwrap())
}

fn giant(height: Option<f64>, brain: &str) -> Arc<CreatureKind> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    kind_of(rig(&path.into(), height).unwrap(), brain)
}

/// Least and largest height of the skin at rest, and its girth, by reference skinning of each vertex of a triangle.
fn measured(rig: &Rig) -> [f64; 3] {
    let palette = rig.skeleton.palette(&rig.skeleton.rest_pose()).unwrap();
    let (mut low, mut high, mut girth) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
    for VertexId(vertex) in rig.collider.triangles().iter().flatten().copied() {
        let p = skin_vertex_reference(&rig.collider, palette.matrices(), VertexId(vertex)).unwrap();
        (low, high) = (low.min(p.y), high.max(p.y));
        girth = girth.max(p.x.abs().min(p.z.abs()));
    }
    [low, high, girth]
}

/// A brain with one state, as JSON. `BODY` is replaced by the body of a test.
const RESTS: &str = r#"{ "body": BODY, "start": "rests", "states": { "rests": {} } }"#;

#[test]
fn height_girth_and_eye_are_those_of_the_skin_at_rest() {
    let near = |a: f64, b: f64| (a - b).abs() <= 0.01 * b.abs();
    let mut seen = 0;
    for path in models() {
        let name = path.file_name().unwrap().to_owned();
        for height in [None, Some(1.0), Some(20.0), Some(300.0)] {
            let Some(rig) = rig(&path, height) else {
                continue;
            };
            let [low, high, girth] = measured(&rig);
            let kind = kind_of(rig, &RESTS.replace("BODY", "{}"));
            assert!(
                near(kind.height(), high - low),
                "{name:?}: {}",
                kind.height()
            );
            assert!(near(kind.girth(), girth), "{name:?}: {}", kind.girth());
            assert!(
                near(kind.eye().y, 0.9 * (high - low)),
                "{name:?}: {}",
                kind.eye()
            );
            if let Some(height) = height {
                assert!(near(kind.height(), height), "{name:?}: {}", kind.height());
            }
            seen += 1;
        }
        // The height in the brain's file sets the height of the creature.
        for height in [1.0, 20.0, 300.0] {
            let Some(rig) = rig(&path, None) else {
                continue;
            };
            let body = format!(r#"{{ "height": {height}, "made_for": 5 }}"#);
            let kind = kind_of(rig, &RESTS.replace("BODY", &body));
            let creature = Creature::new(Arc::clone(&kind), CreatureConfig::default()).unwrap();
            let ball = creature.surface().bounding_ball().unwrap();
            assert!(
                near(creature.height(), height),
                "{name:?}: {}",
                creature.height()
            );
            assert!(near(creature.scale() * kind.height(), height), "{name:?}");
            assert!((creature.rate() - (5.0 / height).sqrt()).abs() < 1e-12);
            assert!(ball.1 > 0.45 * height, "{name:?}: a ball of {} m", ball.1);
        }
    }
    assert!(seen == 4 || seen == 4 * 28, "{seen}");
}

#[test]
fn heights_out_of_range_and_skins_without_height_are_refused() {
    for (body, text) in [
        (r#"{ "height": 0 }"#, "`height` is 0"),
        (r#"{ "made_for": -1 }"#, "`made_for` is -1"),
        (r#"{ "made_for": 1e9 }"#, "`made_for` is 1000000000"),
    ] {
        let error = support::try_kind(&RESTS.replace("BODY", body)).unwrap_err();
        assert!(error.to_string().contains(text), "{error}");
    }
    for made_for in [0.0, f64::NAN, f64::INFINITY] {
        let config = CreatureConfig {
            made_for: Some(made_for),
            ..CreatureConfig::default()
        };
        let kind = support::kind(&brain_file());
        assert!(Creature::new(kind, config).is_err(), "{made_for}");
    }
}

/// A creature lives the same life from a file in metres, in centimetres, in another unit, or scaled to its height.
#[test]
fn the_unit_of_a_file_does_not_matter() {
    let natural = giant(None, &brain_file()).height();
    let kinds = [
        (giant(None, &brain_file()), 1.0),
        (giant(Some(100.0 * natural), &brain_file()), 0.01),
        (giant(Some(natural / 64.0), &brain_file()), 64.0),
        (giant(Some(natural), &brain_file()), 1.0),
    ];
    for seed in [1, 2, 3] {
        let mut creatures: Vec<Creature> = kinds
            .iter()
            .map(|(kind, scale)| {
                let config = CreatureConfig {
                    scale: *scale,
                    seed,
                    ..CreatureConfig::default()
                };
                Creature::new(Arc::clone(kind), config).unwrap()
            })
            .collect();
        let terrain = level_ground();
        for tick in 0..(120.0 / TICK) as u32 {
            let second = f64::from(tick) * TICK;
            // A person runs about in front of the creatures.
            let at = DVec3::new(
                30.0 * libm::sin(0.2 * second),
                0.0,
                45.0 + 20.0 * libm::sin(0.31 * second),
            );
            let people = [person(at)];
            let around = Surroundings {
                creatures: &[],
                terrain: &terrain,
                people: &people[..usize::from(second > 20.0)],
                noises: &[],
            };
            for creature in &mut creatures {
                creature.step(&around).unwrap();
            }
            let [first, others @ ..] = &creatures[..] else {
                unreachable!("there are four");
            };
            for (index, other) in others.iter().enumerate() {
                let what = format!("seed {seed}, {second:.2} s, {index}");
                assert_eq!(other.state().current(), first.state().current(), "{what}");
                let apart = other.state().position().distance(first.state().position());
                assert!(apart < 1e-3 * first.height(), "{what}: {apart} m");
                let turned = (other.state().yaw() - first.state().yaw()).abs();
                assert!(turned < 1e-3, "{what}: {turned}");
                let [a, b] =
                    [first, other].map(|creature| creature.surface().bounding_ball().unwrap());
                assert!(a.0.distance(b.0) < 1e-3 * first.height(), "{what}");
            }
        }
    }
}

/// The time that a creature takes to turn to a noise behind it, seconds; infinite if it never settles.
fn half_turn(height: f64, turn_deg: f64, within_deg: f64, made_for: f64) -> f64 {
    let states = r#"{
        "waits": { "transitions": [{ "to": "turns", "when": ["noise > 0"] }] },
        "turns": { "act": { "turn": { "to": "noise", "within_deg": WITHIN } }, "transitions": [
            { "to": "ends", "when": ["done"] }] },
        "ends": { "final": true }
    }"#;
    let brain = brain_with("waits", &states.replace("WITHIN", &within_deg.to_string()));
    let mut file: serde_json::Value = serde_json::from_str(&brain).unwrap();
    file["body"]["gait"]["turn_deg"] = turn_deg.into();
    file["body"]["height"] = height.into();
    file["body"]["made_for"] = made_for.into();
    let kind = support::kind(&file.to_string());
    let mut creature = Creature::new(Arc::clone(&kind), CreatureConfig::default()).unwrap();
    let terrain = level_ground();
    let behind = DVec3::new(0.01, 0.0, -3.0) * height;
    let ends = kind.brain().find("ends").unwrap();
    for tick in 0..(40.0 * height.sqrt() / TICK) as u32 {
        let noises = [noise(behind)];
        creature
            .step(&with_noises(&terrain, &noises[..usize::from(tick == 30)]))
            .unwrap();
        if creature.state().current() == ends {
            let way = behind - creature.state().position();
            let ahead = libm::atan2(way.x, way.z) - creature.state().yaw();
            let off = libm::remainder(ahead, core::f64::consts::TAU).abs();
            let within = within_deg.max(0.2).to_radians();
            assert!(
                off <= within * 1.01,
                "{height} m, {turn_deg} degrees: {off} of {within}"
            );
            return f64::from(tick - 30) * TICK;
        }
    }
    f64::INFINITY
}

/// The time of a half turn grows with the square root of the height. The turn ends within its angle, at every speed.
#[test]
fn half_a_turn_takes_its_time_and_settles() {
    for turn_deg in [5.0, 20.0, 90.0, 360.0] {
        for within_deg in [0.0, 2.0, 10.0, 60.0] {
            let times = [1.0, 4.0, 41.0, 300.0]
                .map(|height: f64| half_turn(height, turn_deg, within_deg, 41.0) / height.sqrt());
            println!("{turn_deg} degrees a second, within {within_deg}: {times:.2?}");
            let middle = times[2];
            for (height, time) in [1, 4, 41, 300].iter().zip(times) {
                let share = (time / middle - 1.0).abs();
                assert!(
                    share < 0.05,
                    "{turn_deg}, {within_deg}, {height} m: {time} against {middle}"
                );
            }
        }
    }
}

/// Without `made_for` clips keep their speed at any size.
#[test]
fn clips_keep_their_speed_unless_it_is_known_for_what_they_were_made() {
    let mut file: serde_json::Value = serde_json::from_str(&brain_file()).unwrap();
    file["body"].as_object_mut().unwrap().remove("made_for");
    for (scale, made_for, rate) in [
        (0.1, None, 1.0),
        (10.0, None, 1.0),
        (10.0, Some(410.0), 1.0),
        (0.1, Some(41.0), 10f64.sqrt()),
    ] {
        let kind = support::kind(&file.to_string());
        let config = CreatureConfig {
            scale,
            made_for,
            ..CreatureConfig::default()
        };
        let creature = Creature::new(kind, config).unwrap();
        assert!(
            (creature.rate() - rate).abs() < 1e-3 * rate,
            "{}",
            creature.rate()
        );
        assert!((creature.state().animator().rate() - creature.rate()).abs() < 1e-15);
    }
}
