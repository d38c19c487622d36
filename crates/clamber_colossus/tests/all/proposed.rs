//! Brains that are proposed for third-party creatures.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use crate::animals::animals;
use crate::sizes::models;
use crate::support::{
    TICK, level_ground, on_terrain, person, rider, test_models, test_rig, with_people,
};
use clamber_animation::rig::{Channel, Clip, Interpolation, JointId, Keyframes, Marker, Skeleton};
use clamber_animation::{SeamProbe, joint_in_model};
use clamber_colossus::{
    Brain, BrainFile, Creature, CreatureConfig, CreatureKind, Noise, Person, Surroundings,
};
use clamber_gltf::load;
use clamber_surface::mesh::{Rig, SurfaceKind, TriangleId};
use clamber_world::{HalfSpace, MaterialPoint, Obstacle};
use glam::{DVec3, Vec3};

fn rig(path: &Path) -> Option<Rig> {
    Some(load(path).ok()?.rig)
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap();
    name.to_string_lossy().into_owned()
}

fn kind(rig: &Rig, file: &BrainFile) -> Arc<CreatureKind> {
    // The brain is read from text, as in a game.
    let text = serde_json::to_string(file).unwrap();
    let brain = Brain::from_json(&text, TICK).unwrap();
    assert_eq!(brain.file(), file);
    Arc::new(CreatureKind::new(rig, brain).unwrap())
}

/// Records of a creature's life.
#[derive(Default)]
struct Life {
    visited: BTreeSet<String>,
    /// The longest time in one state, seconds.
    longest: (f64, String),
    lasted: f64,
    home: Option<DVec3>,
    /// Largest distance from the place where it began, metres.
    farthest: f64,
    turned: f64,
}

impl Life {
    /// Steps the creature for some seconds.
    fn pass(&mut self, creature: &mut Creature, seconds: f64, people: &[Person], noises: &[Noise]) {
        let terrain = level_ground();
        let place = creature.state().position();
        let home = self.home.get_or_insert(place).to_owned();
        for _ in 0..(seconds / TICK) as u32 {
            let around = Surroundings {
                terrain: &terrain,
                people,
                noises,
                ..Surroundings::default()
            };
            let before = creature.state().brain().current();
            let yaw = creature.state().yaw();
            creature.step(&around).unwrap();
            let brain = creature.kind().brain();
            let now = creature.state().brain().current();
            self.lasted = if now == before {
                self.lasted + TICK
            } else {
                0.0
            };
            if self.lasted > self.longest.0 {
                self.longest = (self.lasted, brain.path(now).to_owned());
            }
            self.visited.insert(brain.path(now).to_owned());
            let way = creature.state().position() - home;
            self.farthest = self.farthest.max(way.length());
            let turn = (creature.state().yaw() - yaw).abs();
            self.turned += turn.min(core::f64::consts::TAU - turn);
        }
    }
}

/// Plays a share of a life of ten minutes for each creature: alone, with a person before it and behind it, with a
/// rider, and with noises.
fn lives(height: f64, share: f64) {
    let mut count = 0;
    for path in models() {
        let Some(rig) = rig(&path) else { continue };
        let file = BrainFile::propose(&rig, height).unwrap();
        let kind = kind(&rig, &file);
        assert!(
            kind.report().never.is_empty(),
            "{}: {:?}",
            name(&path),
            kind.report().never
        );
        let config = CreatureConfig {
            seed: 3,
            ..CreatureConfig::default()
        };
        let mut creature = Creature::new(Arc::clone(&kind), config).unwrap();
        let mut life = Life::default();
        life.pass(&mut creature, 240.0 * share, &[], &[]);
        let says = |what: &str, life: &Life| {
            format!("{} at {height} m: {what}; {:?}", name(&path), life.visited)
        };
        let has = |life: &Life, state: &str| life.visited.iter().any(|path| path.contains(state));
        assert!(has(&life, "sleeps"), "{}", says("it never slept", &life));
        let walks = kind.can_walk();
        // A person shows up in front of the creature, and later behind it.
        let world = creature.state().position();
        for (way, seconds) in [(1.0, 90.0), (-1.0, 90.0)] {
            let yaw = creature.state().yaw();
            let ahead = DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw));
            let prey = person(world + ahead * (way * (3.0 * height).min(120.0)));
            let before = life.turned;
            let (place, loudness) = (prey.middle(), 1.0);
            for _ in 0..(4.0 + 0.2 * seconds * share) as u32 {
                life.pass(&mut creature, TICK, &[prey], &[Noise { place, loudness }]);
                life.pass(&mut creature, 5.0, &[prey], &[]);
            }
            assert!(has(&life, "alert"), "{}", says("nobody was noticed", &life));
            let turned = life.turned - before;
            assert!(
                way > 0.0 || !walks || turned > 1.0,
                "{}",
                says("it did not turn", &life)
            );
        }
        let at = creature.state().position() + DVec3::Y * height;
        let rider = rider(at, TriangleId(0));
        life.pass(&mut creature, 20.0, &[rider], &[]);
        life.pass(&mut creature, 130.0 * share, &[rider], &[]);
        assert!(
            has(&life, "ridden/shakes"),
            "{}",
            says("it bore its rider", &life)
        );
        let is_far = life.farthest > 0.2 * height;
        let far = format!("it goes {} m", life.farthest);
        assert_eq!(is_far, walks, "{}", says(&far, &life));
        let (longest, state) = &life.longest;
        println!(
            "{:<32} at {height} m: {longest:>5.1} s in {state}",
            name(&path)
        );
        // By Froude's law, everything takes longer for a larger creature.
        let most = 60.0 * (height / 20.0).sqrt().max(1.0);
        assert!(
            *longest < most,
            "{}",
            says(&format!("{longest} s in {state}"), &life)
        );
        if file.body.weak_points.is_empty() {
            // The giant has its own weak points, which open in an order.
            continue;
        }
        // A stab into the skin at the weak point.
        let place = creature.weak_point(0).unwrap();
        let skin = creature.surface().in_world();
        let hit = skin.closest_point(place, height).unwrap();
        let at = MaterialPoint::on_triangle(hit.triangle, hit.barycentric);
        let (place, damage) = (hit.point, 3.0);
        let done = creature.hurt(&at, place, damage);
        assert_eq!(
            done,
            3.0,
            "{}",
            says("its weak point is not at its skin", &life)
        );
        life.pass(&mut creature, 1.0, &[], &[]);
        assert!(has(&life, "dies"), "{}", says("it did not die", &life));
        count += 1;
    }
    let is_there = std::env::var_os("CLAMBER_TEST_DATA").is_some();
    assert_eq!(count, if is_there { 27 } else { 0 });
}

#[test]
fn creatures_from_elsewhere_live_by_what_is_proposed() {
    lives(20.0, 0.3);
}

/// A proposed attack strikes a person that stands in front of the creature.
#[test]
fn attacks_that_are_proposed_strike_who_stays() {
    let (mut count, mut missed) = (0, Vec::new());
    for path in models() {
        let Some(rig) = rig(&path) else { continue };
        for height in [3.0, 20.0, 60.0] {
            let file = BrainFile::propose(&rig, height).unwrap();
            let text = serde_json::to_string(&file).unwrap();
            if !text.contains("\"attack\"") {
                continue;
            }
            let kind = kind(&rig, &file);
            let mut creature = Creature::new(Arc::clone(&kind), CreatureConfig::default()).unwrap();
            let prey = [person(if kind.can_walk() {
                DVec3::new(0.3, 0.0, 2.0) * height
            } else {
                DVec3::Z * (0.6 * height)
            })];
            let terrain = level_ground();
            let most = (180.0 * (height / 20.0).sqrt().max(1.0) / TICK) as u32;
            let struck = (0..most).any(|_| {
                !creature
                    .step(&with_people(&terrain, &prey))
                    .unwrap()
                    .blows
                    .is_empty()
            });
            // A creature that cannot walk counts only if the person is within its reach.
            if struck || kind.can_walk() {
                count += 1;
            }
            if !struck {
                missed.push(format!("{} at {height} m", name(&path)));
            }
        }
    }
    println!("{count} attack, without a blow: {missed:#?}");
    // The frog cannot walk to the person. At 60 m a limb may come down too far away.
    let near = missed
        .iter()
        .filter(|name| !name.contains("Frog") && !name.contains("60 m"));
    let near: Vec<&String> = near.collect();
    let is_there = std::env::var_os("CLAMBER_TEST_DATA").is_some();
    assert!(
        !is_there || count > 36 && near.is_empty() && missed.len() <= 6,
        "{count}: {missed:?}"
    );
}

/// While a creature with legs attacks, neither its feet nor its skin go far into the ground. Its clip lifts feet and
/// puts them down again faster than feet may be moved to another place.
#[test]
fn attacks_that_are_proposed_stay_above_the_ground() {
    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let around = on_terrain(&terrain);
    let mut worst = [0f64; 2];
    let mut count = 0;
    for path in models() {
        let Some(rig) = rig(&path) else { continue };
        for height in [3.0, 20.0] {
            let file = BrainFile::propose(&rig, height).unwrap();
            let legs = file.body.legs.len();
            let kind = kind(&rig, &file);
            let mut one = Creature::new(Arc::clone(&kind), CreatureConfig::default()).unwrap();
            if legs == 0 || !one.enter("strikes") {
                continue;
            }
            count += 1;
            let mut deepest = [0f64; 2];
            let mut skin: Vec<Vec3> = Vec::new();
            for tick in 0..(8.0 * (height / 20.0).sqrt() / TICK) as u32 {
                one.step(&around).unwrap();
                if tick % 5 != 0 {
                    continue;
                }
                let feet = (0..legs).filter_map(|leg| one.foot_clearance(leg, &terrain));
                deepest[0] = feet.fold(deepest[0], f64::min);
                one.surface().clone().skin_all(&mut skin);
                let origin = one.surface().world_from_model();
                let skin = skin.iter();
                let low = skin.map(|place| origin.transform_point(place.as_dvec3()).y);
                deepest[1] = low.fold(deepest[1], f64::min);
            }
            let deepest = deepest.map(|depth| -depth / height);
            println!(
                "{:<24} at {height} m: feet and skin {deepest:.3?}",
                name(&path)
            );
            worst = [worst[0].max(deepest[0]), worst[1].max(deepest[1])];
        }
    }
    println!("{count}: feet and skin at most {worst:.3?} of the height in the ground");
    let is_there = std::env::var_os("CLAMBER_TEST_DATA").is_some();
    assert!(!is_there || count > 20, "{count}");
    // A head may strike into the ground if its clip does so.
    assert!(worst[0] < 0.065 && worst[1] < 0.1, "{worst:?}");
}

#[test]
#[ignore = "takes minutes: ten of each creature, at three sizes"]
fn creatures_from_elsewhere_live_for_ten_minutes() {
    for height in [3.0, 20.0, 60.0] {
        lives(height, 1.0);
    }
}

/// The proposed legs have the same feet and toes as the legs that were chosen by hand for these files.
#[test]
fn legs_are_those_that_people_find() {
    let Some(folder) = test_models("legs") else {
        return;
    };
    for animal in animals() {
        // This file has no walk, so its creature needs no legs.
        if animal.file == "gltf_spider_animated.gltf" {
            continue;
        }
        let path = folder.join(animal.file);
        let file = BrainFile::propose(&rig(&path).unwrap(), 20.0).unwrap();
        let found: BTreeMap<String, Option<String>> = file
            .body
            .legs
            .iter()
            .map(|leg| (leg.joints.last().unwrap().clone(), leg.toe.clone()))
            .collect();
        let known = animal.legs.iter().map(|leg| {
            let joints = leg["joints"].as_array().unwrap();
            let foot = joints.last().unwrap().as_str().unwrap().to_owned();
            (foot, leg["toe"].as_str().map(str::to_owned))
        });
        assert_eq!(found, known.collect(), "{}", animal.file);
        for leg in &file.body.legs {
            let known = animal.legs.iter().find(|known| {
                let joints = known["joints"].as_array().unwrap();
                joints.last().unwrap() == leg.joints.last().unwrap().as_str()
            });
            let known: Vec<&str> = known.unwrap()["joints"]
                .as_array()
                .unwrap()
                .iter()
                .map(|joint| joint.as_str().unwrap())
                .collect();
            // At most one joint more or less, as the joint at which a leg begins is a matter of taste.
            let same = leg
                .joints
                .iter()
                .filter(|joint| known.contains(&joint.as_str()));
            assert!(same.count() + 1 >= known.len(), "{leg:?} {known:?}");
            assert!(leg.joints.len() <= known.len() + 1, "{leg:?} {known:?}");
        }
    }
}

#[test]
fn skin_is_fur_and_the_weak_point_is_on_it() {
    for path in models() {
        let Some(rig) = rig(&path) else { continue };
        let file = BrainFile::propose(&rig, 20.0).unwrap();
        let kind = kind(&rig, &file);
        let has_fur = rig
            .collider
            .tags()
            .iter()
            .any(|tag| tag.kind == SurfaceKind::Fur);
        if has_fur {
            assert_eq!(kind.mesh().tags(), rig.collider.tags());
            continue;
        }
        let mut tags = kind.mesh().tags().iter();
        assert!(
            tags.all(|tag| tag.kind == SurfaceKind::Fur),
            "{}",
            name(&path)
        );
        let point = &kind.weak_points()[0];
        let rest = kind.skeleton().rest_pose();
        let frame = joint_in_model(kind.skeleton(), &rest, point.joint).unwrap();
        let at = frame.transform_point3(point.position.as_dvec3());
        let palette = kind.skeleton().palette(&rest).unwrap();
        let skin = clamber_surface::skin::skin(kind.mesh(), palette.matrices()).unwrap();
        let gap = skin.iter().map(|place| place.as_dvec3().distance(at));
        let gap = gap.fold(f64::INFINITY, f64::min);
        assert!(gap < 2e-3 * kind.height(), "{}: {gap}", name(&path));
    }
}

#[test]
fn what_is_played_again_and_again_ends_as_it_begins() {
    let mut closed = 0;
    for path in models() {
        let Some(rig) = rig(&path) else { continue };
        let file = BrainFile::propose(&rig, 20.0).unwrap();
        closed += file
            .body
            .clips
            .values()
            .filter(|clip| clip.close.is_some())
            .count();
        let kind = kind(&rig, &file);
        let probe = SeamProbe::new(kind.skeleton(), kind.mesh(), kind.height());
        let gait = file
            .body
            .gait
            .iter()
            .flat_map(|gait| [&gait.idle, &gait.walk]);
        for name in gait {
            let clip = kind.clips().find(name).unwrap();
            let seam = probe.measure(kind.clips().clip(clip).unwrap()).unwrap();
            assert!(seam.is_loop(), "{} {name}: {seam:?}", path.display());
        }
    }
    println!("{closed} clips were closed");
    assert!(closed > 0 || std::env::var_os("CLAMBER_TEST_DATA").is_none());
}

#[test]
fn what_is_no_height_is_refused() {
    let rig = rig(&models()[0]).unwrap();
    for height in [0.0, -1.0, 1e-4, 1e6, f64::NAN, f64::INFINITY] {
        let error = BrainFile::propose(&rig, height).unwrap_err().to_string();
        assert!(error.contains("height"), "{error}");
    }
}

/// The Trex of the test data with a changed rig.
fn changed(change: impl FnOnce(&mut Rig)) -> Option<Rig> {
    let mut rig = test_rig("Trex.glb")?;
    change(&mut rig);
    Some(rig)
}

fn keys(name: &str, seconds: f32) -> Clip {
    let values = Keyframes::Translation(vec![Vec3::ZERO, Vec3::Y]);
    let channel = Channel::new(
        JointId(0),
        Interpolation::Linear,
        vec![0.0, seconds],
        values,
    );
    Clip::new(name, vec![channel.unwrap()])
}

#[test]
fn clips_without_end_take_no_time() {
    let rig = changed(|rig| {
        rig.clips = ["Idle", "Walk", "Attack"]
            .map(|name| keys(name, 1e9))
            .to_vec();
    });
    let Some(rig) = rig else { return };
    let file = BrainFile::propose(&rig, 20.0).unwrap();
    assert_eq!((file.body.gait.as_ref(), file.body.clips.len()), (None, 0));
}

#[test]
fn what_does_not_fit_is_left_out() {
    // The file's own markers are in the wrong order.
    let rig = changed(|rig| {
        let marker = |name: &str, time| Marker {
            name: name.into(),
            time,
        };
        for clip in &mut rig.clips {
            if clip.name.ends_with("Attack") {
                let markers = vec![marker("active", 0.6), marker("recovery", 0.5)];
                *clip = clip.clone().with_markers(markers).unwrap();
            }
        }
    });
    let Some(rig) = rig else { return };
    let file = BrainFile::propose(&rig, 20.0).unwrap();
    let text = serde_json::to_string(&file).unwrap();
    assert!(
        !text.contains("attack\":") && text.contains("TRex_Walk"),
        "{text}"
    );
    kind(&rig, &file);
    // If two joints have the same name, the name stands for the first one only.
    let twice = |name: &'static str, other: &'static str| {
        changed(move |rig| {
            let mut joints = rig.skeleton.joints().to_vec();
            for joint in &mut joints {
                if joint.name == name {
                    joint.name = other.to_owned();
                }
            }
            rig.skeleton = Skeleton::new(joints).unwrap();
        })
        .unwrap()
    };
    // The root gets the head's name, and comes before the head.
    let rig = twice("root", "Head");
    let file = BrainFile::propose(&rig, 20.0).unwrap();
    let kind = kind(&rig, &file);
    for (name, _) in file.body.head.iter().flat_map(|head| &head.joints) {
        assert_ne!(name, "Head");
    }
    assert_ne!(
        file.body.weak_points[0].joint,
        "Head",
        "{:?}",
        kind.height()
    );
    let rig = twice("BackFoot.L", "BackFoot.R");
    let file = BrainFile::propose(&rig, 20.0).unwrap();
    assert!(file.body.legs.is_empty(), "{:?}", file.body.legs);
}
