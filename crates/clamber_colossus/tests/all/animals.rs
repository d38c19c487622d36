//! Feet of third-party animals: two, four and eight legs, of three and four joints, with feet below the leg or beside
//! it.

use crate::support;

use std::sync::Arc;

use crate::support::{TICK, level_ground, noise, test_rig, with_noises};
use clamber_animation::rig::{
    Channel, Clip, Interpolation, JointId, Keyframes, Playback, Skeleton,
};
use clamber_colossus::{Brain, Creature, CreatureConfig, CreatureKind};
use clamber_surface::mesh::VertexId;
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

/// An animal of the test data.
pub(crate) struct Animal {
    pub(crate) file: &'static str,
    pub(crate) legs: Vec<Value>,
    idle: &'static str,
    walk: &'static str,
    /// Height for which the clips were made, metres: roughly the height of a real animal.
    made_for: f64,
}

/// A left and a right leg. `*` in the names of their joints stands for `L` and `R`.
fn both(joints: &[&str], toe: Option<&str>) -> Vec<Value> {
    let side = |side: &str| {
        let joints: Vec<String> = joints.iter().map(|name| name.replace('*', side)).collect();
        let mut leg = json!({ "joints": joints });
        if let Some(toe) = toe {
            leg["toe"] = toe.replace('*', side).into();
        }
        leg
    };
    vec![side("L"), side("R")]
}

pub(crate) fn animals() -> Vec<Animal> {
    let dinosaur = |front: bool| {
        let mut legs = both(&["BackUpLeg.*", "BackLowLeg.*", "BackFoot.*"], None);
        if front {
            legs.extend(both(
                &["FrontUpLeg.*", "FrontLowLeg.*", "FrontFoot.*"],
                None,
            ));
        }
        legs
    };
    let hoofed = || {
        let mut legs = both(
            &[
                "BackLeg.*",
                "BackUpperLeg.*",
                "BackLowerLeg.*",
                "IKBackLeg.*",
            ],
            Some("FFB.*"),
        );
        let front = ["FrontUpperLeg.*", "FrontLowerLeg.*", "IKFrontLeg.*"];
        legs.extend(both(&front, Some("FF.*")));
        legs
    };
    let leg = |joints: &[&str]| json!({ "joints": joints });
    let mut spider = Vec::new();
    for name in ["FrontLeg", "MidFrontLeg", "MidBackLeg", "BackLeg"] {
        for side in ["L", "R"] {
            let joints = ["", "2", "3"].map(|number| format!("{name}{number}.{side}"));
            let foot = name.replace("Leg", "Foot");
            // The file itself misnames this foot.
            let foot = match (name, side) {
                ("FrontLeg", "R") => "FrontFoot2.R".to_owned(),
                _ => format!("{foot}.{side}"),
            };
            spider.push(json!({ "joints": [joints[0], joints[1], joints[2], foot] }));
        }
    }
    let mut other_spider = Vec::new();
    for number in 1..=4 {
        let name = |part: &str| format!("Leg{number}{part}.*");
        let joints = ["Upper", "Mid", "Lower", "Fore"].map(name);
        other_spider.extend(both(&joints.each_ref().map(String::as_str), None));
    }
    vec![
        Animal {
            file: "Trex.glb",
            legs: dinosaur(false),
            idle: "Armature|TRex_Idle",
            walk: "Armature|TRex_Walk",
            made_for: 4.0,
        },
        Animal {
            file: "Apatosaurus.glb",
            legs: dinosaur(true),
            idle: "Armature|Apatosaurus_Idle",
            walk: "Armature|Apatosaurus_Walk",
            made_for: 6.0,
        },
        Animal {
            file: "Triceratops.glb",
            legs: dinosaur(true),
            idle: "Armature|Triceratops_Idle",
            walk: "Armature|Triceratops_Walk",
            made_for: 3.0,
        },
        Animal {
            file: "Stag.glb",
            legs: hoofed(),
            idle: "AnimalArmature|Idle",
            walk: "AnimalArmature|Walk",
            made_for: 2.0,
        },
        Animal {
            file: "Bull.glb",
            legs: hoofed(),
            idle: "AnimalArmature|Idle",
            walk: "AnimalArmature|Walk",
            made_for: 1.8,
        },
        Animal {
            file: "Fox.glb",
            legs: vec![
                leg(&["b_LeftUpperArm_09", "b_LeftForeArm_010", "b_LeftHand_011"]),
                leg(&["b_RightUpperArm_06", "b_RightForeArm_07", "b_RightHand_08"]),
                leg(&[
                    "b_LeftLeg01_015",
                    "b_LeftLeg02_016",
                    "b_LeftFoot01_017",
                    "b_LeftFoot02_018",
                ]),
                leg(&[
                    "b_RightLeg01_019",
                    "b_RightLeg02_020",
                    "b_RightFoot01_021",
                    "b_RightFoot02_022",
                ]),
            ],
            idle: "Survey",
            walk: "Walk",
            made_for: 0.6,
        },
        Animal {
            file: "Spider.glb",
            legs: spider,
            idle: "SpiderArmature|Spider_Idle",
            walk: "SpiderArmature|Spider_Walk",
            made_for: 1.0,
        },
        Animal {
            file: "gltf_spider_animated.gltf",
            legs: other_spider,
            idle: "stands",
            walk: "stands",
            made_for: 1.0,
        },
    ]
}

pub(crate) fn kind(animal: &Animal, height: f64) -> Option<Arc<CreatureKind>> {
    kind_with(animal, height, |clips, _| clips)
}

/// The kind of an animal, with its clips replaced by `change`.
fn kind_with(
    animal: &Animal,
    height: f64,
    change: impl Fn(Vec<Clip>, &Skeleton) -> Vec<Clip>,
) -> Option<Arc<CreatureKind>> {
    let mut rig = test_rig(animal.file)?;
    let mut brain = json!({
        "body": {
            "height": height,
            "made_for": animal.made_for,
            "legs": animal.legs,
            "gait": { "idle": animal.idle, "walk": animal.walk, "turn_deg": 40, "steer_deg": 20 }
        },
        "start": "stands",
        "states": {
            "stands": { "transitions": [{ "to": "turns", "when": ["noise > 0"], "after": 1 }] },
            "turns": { "act": { "turn": { "to": "noise", "within_deg": 5 } }, "transitions": [
                { "to": "walks", "when": ["done"] }] },
            "walks": { "act": { "walk": { "to": "noise", "within": 0.5 * height } }, "transitions": [
                { "to": "stands", "when": ["done"] }] }
        }
    });
    let mut clips = change(rig.clips, &rig.skeleton);
    if animal.walk == "stands" {
        // The file has one clip with all of its motions except a walk. The spider stands still in it from 2.3 to 3.4 s.
        clips.push(still(&clips[0], &rig.skeleton, 3.0));
        brain["body"]["gait"]["speed"] = json!(0.3);
    }
    rig.clips = clips;
    rig.weak_points.clear();
    let brain = Brain::from_json(&brain.to_string(), TICK).unwrap();
    Some(Arc::new(CreatureKind::new(&rig, brain).unwrap()))
}

/// A clip of one second that holds the pose of another clip at a time.
fn still(clip: &Clip, skeleton: &Skeleton, time: f64) -> Clip {
    let pose = clip
        .sample(&skeleton.rest_pose(), time, Playback::Clamp)
        .unwrap();
    let channels = pose.transforms.iter().enumerate().flat_map(|(index, at)| {
        let joint = JointId(index as u32);
        let values = [
            Keyframes::Translation(vec![at.translation; 2]),
            Keyframes::Rotation(vec![at.rotation; 2]),
        ];
        values.map(|values| {
            Channel::new(joint, Interpolation::Linear, vec![0.0, 1.0], values).unwrap()
        })
    });
    Clip::new("stands".to_owned(), channels.collect())
}

/// Measurements of feet that stand.
#[derive(Debug, Default)]
struct Figures {
    /// Largest height of a settled sole above the ground, as a share of the tolerance: the larger of 1 % of the foot's
    /// length and 0.1 % of the height.
    gap: f64,
    /// Largest depth of a settled sole in the ground, as a share of the same tolerance.
    depth: f64,
    /// Largest level distance that a settled sole slides, as a share of the same tolerance.
    slide: f64,
    /// Mean share of planted feet while the animal stands, after it has come to rest.
    standing: f64,
    plants: usize,
    walked: f64,
    states: [usize; 3],
    planted: f64,
}

fn live(kind: &Arc<CreatureKind>, height: f64) -> Figures {
    let mut creature = Creature::new(Arc::clone(kind), CreatureConfig::default()).unwrap();
    let terrain = level_ground();
    let legs = kind.brain().file().body.legs.len();
    let feet: Vec<Vec<VertexId>> = (0..legs).map(|leg| foot(kind, leg)).collect();
    let mut figures = Figures::default();
    let (mut rests, mut resting) = (0, 0.0);
    let mut skin: Vec<Vec3> = Vec::new();
    let mut stands: Vec<Option<(u32, [DVec3; 4])>> = vec![None; legs];
    let slow = height.sqrt();
    let lap = 12.0 * slow * (0.4 * kind.height() / kind.walking_speed().unwrap()).max(1.0);
    let seconds = 6.0 * lap;
    let settled = (0.6 * slow / TICK) as u32;
    for tick in 0..(seconds / TICK) as u32 {
        // In each lap it hears a noise at another place.
        let turn = (f64::from(tick) * TICK / lap) as u32;
        let angle = f64::from(turn) * 2.4;
        let place = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * (3.0 * height);
        let noises = [noise(place)];
        let rings = (f64::from(tick) * TICK).rem_euclid(lap) > 3.0 * slow;
        let around = with_noises(&terrain, &noises[..usize::from(rings)]);
        let from = creature.state().position();
        creature.step(&around).unwrap();
        figures.walked += creature.state().position().distance(from) / height;
        figures.states[creature.state().current().index()] += 1;
        creature.surface().clone().skin_all(&mut skin);
        let state = creature.state().current();
        rests = if kind.brain().path(state) == "stands" {
            rests + 1
        } else {
            0
        };
        if rests > 2 * settled {
            let planted = (0..legs)
                .filter(|leg| creature.state().is_planted(*leg))
                .count();
            figures.standing += planted as f64 / legs as f64;
            resting += 1.0;
        }
        let world = creature.surface().world_from_model();
        for leg in 0..legs {
            let heights = feet[leg].iter().map(|vertex| {
                let place = world.transform_point(skin[vertex.index()].as_dvec3());
                place.y
            });
            let lowest = heights.fold(f64::INFINITY, f64::min);
            if !creature.state().is_planted(leg) {
                stands[leg] = None;
                continue;
            }
            let sole = creature.sole(leg).unwrap();
            figures.planted += 1.0 / legs as f64;
            let (since, at) = *stands[leg].get_or_insert_with(|| {
                figures.plants += 1;
                (tick, sole)
            });
            if tick == since + settled {
                stands[leg] = Some((since, sole));
            }
            if tick <= since + settled {
                continue;
            }
            let most = (0.01 * kind.foot_length(leg) * creature.scale()).max(0.001 * height);
            figures.gap = figures.gap.max(lowest / most);
            figures.depth = figures.depth.max(-lowest / most);
            let clearance = creature.foot_clearance(leg, &terrain).unwrap();
            figures.gap = figures.gap.max(clearance / most);
            figures.depth = figures.depth.max(-clearance / most);
            let slide = sole
                .iter()
                .zip(at)
                .map(|(a, b)| a.with_y(0.0).distance(b.with_y(0.0)))
                .fold(0.0, f64::max);
            figures.slide = figures.slide.max(slide / most);
        }
    }
    figures.standing /= resting;
    figures.planted /= seconds / TICK;
    figures
}

/// The vertices that follow a foot with more than half of their weight.
fn foot(kind: &CreatureKind, leg: usize) -> Vec<VertexId> {
    let skeleton = kind.skeleton();
    let file = &kind.brain().file().body.legs[leg];
    let ankle = skeleton.find(file.joints.last().unwrap()).unwrap();
    let mesh = kind.mesh();
    let share = |vertex: &VertexId| {
        let ours = mesh.influences(*vertex);
        let ours = ours.filter(|(joint, _)| skeleton.is_descendant_or_self(*joint, ankle));
        ours.map(|(_, weight)| weight).sum::<f32>()
    };
    let all = || (0..mesh.positions().len() as u32).map(VertexId);
    all().filter(|vertex| share(vertex) > 0.5).collect()
}

/// While an animal stands, walks and turns, its planted feet are on the ground within 1 % of the foot's length or 0.1 %
/// of the animal's height.
#[test]
fn feet_stand_on_the_ground() {
    let mut worst = Vec::new();
    for animal in animals() {
        for height in [1.0, 20.0] {
            let Some(kind) = kind(&animal, height) else {
                return;
            };
            let figures = live(&kind, height);
            println!(
                "{} {height} m, {:.3} heights/s: {figures:.2?}",
                animal.file,
                kind.walking_speed().unwrap() / kind.height()
            );
            let stands = figures.gap.max(figures.depth).max(figures.slide) <= 1.0;
            let lives = figures.walked > 10.0 && figures.states.iter().all(|ticks| *ticks > 60);
            if !stands || !lives || figures.standing < 0.95 {
                worst.push(animal.file);
            }
        }
    }
    assert!(worst.is_empty(), "{worst:?}");
}

/// Some exporters bake legs that are stretched along their bones. The feet of such legs stand on the ground, too.
#[test]
fn stretched_legs_stand_too() {
    for file in ["Fox.glb", "Bull.glb"] {
        let all = animals();
        let animal = all.iter().find(|animal| animal.file == file).unwrap();
        let stretched = |mut clips: Vec<Clip>, skeleton: &Skeleton| {
            let legs = animal
                .legs
                .iter()
                .flat_map(|leg| leg["joints"].as_array().unwrap());
            let joints: Vec<JointId> = legs
                .map(|name| skeleton.find(name.as_str().unwrap()).unwrap())
                .collect();
            for clip in &mut clips {
                let mut channels = clip.channels().to_vec();
                channels.extend(joints.iter().map(|joint| {
                    let rest = skeleton.joints()[joint.index()].rest.scale;
                    let values = vec![rest * Vec3::new(0.99, 1.03, 1.0); 2];
                    let values = Keyframes::Scale(values);
                    Channel::new(*joint, Interpolation::Linear, vec![0.0, 1.0], values).unwrap()
                }));
                let speed = clip.ground_speed();
                *clip = Clip::new(clip.name.clone(), channels)
                    .with_ground_speed(speed)
                    .unwrap();
            }
            clips
        };
        let Some(kind) = kind_with(animal, 4.0, stretched) else {
            return;
        };
        let figures = live(&kind, 4.0);
        println!("{file}: {figures:.2?}");
        let worst = figures.gap.max(figures.depth).max(figures.slide);
        assert!(
            worst <= 1.0 && figures.standing > 0.95,
            "{file}: {figures:?}"
        );
    }
}

/// Invalid legs are refused with the names of their joints.
#[test]
fn legs_that_cannot_be_are_refused_by_name() {
    let leg = |joints: &[&str]| {
        let brain = json!({
            "body": { "legs": [{ "joints": joints }] }, "start": "rests", "states": { "rests": {} }
        });
        support::try_kind(&brain.to_string())
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    // Legs of the giant with too few or too many joints, in the wrong order, or with a joint that does not exist.
    for (joints, text) in [
        (
            &["thigh.L"][..],
            "`joints` is 1, which is not from 2 to 5 joints of a leg",
        ),
        (
            &["pelvis", "thigh.L", "shin.L", "foot.L", "toe.L", "toe.L"],
            "`joints` is 6",
        ),
        (
            &["shin.L", "thigh.L", "foot.L"],
            "`thigh.L` is not below `shin.L`",
        ),
        (
            &["thigh.L", "shin.L", "shin.L"],
            "`shin.L` is not below `shin.L`",
        ),
        (&["thigh.L", "shin.L", "nose"], "there is no joint `nose`"),
    ] {
        let error = leg(joints);
        assert!(error.contains(text), "{joints:?}: {error}");
    }
    // A pole target is a helper joint: no skin moves with it.
    let Some(mut rig) = test_rig("Stag.glb") else {
        return;
    };
    let joints = ["BackLeg.L", "BackUpperLeg.L", "PoleTarget.L"];
    let brain = json!({
        "body": { "legs": [{ "joints": joints }] }, "start": "rests", "states": { "rests": {} }
    });
    rig.weak_points.clear();
    let brain = Brain::from_json(&brain.to_string(), TICK).unwrap();
    let error = CreatureKind::new(&rig, brain)
        .map(|_| ())
        .unwrap_err()
        .to_string();
    let text = "the leg of `BackLeg.L`, `BackUpperLeg.L`, `PoleTarget.L` cannot be moved: no skin moves with its \
                foot `PoleTarget.L`";
    assert_eq!(error, text);
}
