//! Third-party files: the brain's file adds the facts that they lack.

use std::sync::Arc;

use crate::support::{TICK, level_ground, noise, person, test_rig, with_noises, with_people};
use clamber_animation::SeamProbe;
use clamber_animation::rig::{
    Channel, Clip, Interpolation, JointId, Keyframes, Marker, Playback, Skeleton, Transform,
};
use clamber_colossus::{Brain, Creature, CreatureConfig, CreatureEvent, CreatureKind};
use clamber_surface::mesh::Rig;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId};
use glam::{DVec3, Quat, Vec3};
use serde_json::{Value, json};

fn try_kind(rig: &Rig, brain: &Value) -> Result<Arc<CreatureKind>, String> {
    let brain = Brain::from_json(&brain.to_string(), TICK).map_err(|error| error.to_string())?;
    let kind = CreatureKind::new(rig, brain).map_err(|error| error.to_string())?;
    Ok(Arc::new(kind))
}

/// A Trex that bites. Its brain's file gives the window in which its jaws hurt, and its weak points.
fn trex() -> Value {
    json!({
        "body": {
            "height": 12,
            "clips": { "Armature|TRex_Attack": { "markers": { "active": 0.3, "recovery": 0.8, "snap": [0.35, 0.7] } } },
            "weak_points": [
                { "name": "snout", "joint": "Head", "at": [0, 0, 0.2], "radius": 0.1, "hit_points": 2, "major": true },
                { "name": "tail", "joint": "Tail5", "radius": 0.05, "hit_points": 1 }
            ]
        },
        "start": "waits",
        "states": {
            "waits": { "transitions": [{ "to": "bites", "after": 0.5 }] },
            "bites": { "act": { "attack": { "clip": "Armature|TRex_Attack", "limb": ["Neck", "Head"], "damage": 0.4, "throw": 5 } },
                "transitions": [{ "to": "waits" }] }
        }
    })
}

#[test]
fn markers_and_weak_points_of_the_brains_file_are_as_good_as_the_files_own() {
    let Some(rig) = test_rig("Trex.glb") else {
        return;
    };
    let kind = try_kind(&rig, &trex()).unwrap();
    let names: Vec<&str> = kind
        .weak_points()
        .iter()
        .map(|point| point.name.as_str())
        .collect();
    assert_eq!(names, ["snout", "tail"]);
    let orders: Vec<u32> = kind.weak_points().iter().map(|point| point.order).collect();
    assert_eq!(orders, [1, 0]);
    let mut creature = Creature::new(Arc::clone(&kind), CreatureConfig::default()).unwrap();
    // At rest the weak point is a fifth of the creature's height ahead of the head's joint.
    let head = kind.skeleton().find("Head").unwrap();
    let rest = kind
        .skeleton()
        .palette(&kind.skeleton().rest_pose())
        .unwrap();
    let point = &kind.weak_points()[0];
    let frame = rest.model_from_joint(head).unwrap();
    let at = frame.transform_point3(point.position.as_dvec3()) - frame.translation;
    let ahead = DVec3::Z * (0.2 * kind.height());
    assert!(at.distance(ahead) < 1e-3 * kind.height(), "{at}");
    let radius = f64::from(point.radius) * creature.scale();
    assert!((radius - 1.2).abs() < 1e-3, "{radius} m");
    let terrain = level_ground();
    let (mut blows, mut snaps) = (0, 0);
    for _ in 0..300 {
        let mouth = creature.weak_point(0).unwrap();
        let people = [person(mouth - DVec3::Y * 0.8)];
        let report = creature.step(&with_people(&terrain, &people)).unwrap();
        blows += report.blows.len();
        let is_snap = |event: &&CreatureEvent| matches!(event, CreatureEvent::Marker { name } if name == "snap");
        snaps += report.events.iter().filter(is_snap).count();
    }
    println!("{blows} blows, {snaps} snaps");
    assert!(blows >= 2 && snaps >= 4);
    assert!(kind.report().never.is_empty(), "{:?}", kind.report().never);
}

#[test]
fn skin_is_fur_by_joint_and_by_material() {
    let Some(rig) = test_rig("Trex.glb") else {
        return;
    };
    let with = |fur: Value| {
        let mut brain = trex();
        brain["body"]["fur"] = fur;
        try_kind(&rig, &brain)
    };
    let is_fur = |kind: &CreatureKind, triangle: usize| {
        kind.mesh().tags()[triangle].kind == SurfaceKind::Fur
    };
    let plain = with(json!({})).unwrap();
    assert!(Arc::ptr_eq(plain.mesh(), &rig.collider));
    let tail = with(json!({ "joints": ["Tail*", "Head"] })).unwrap();
    let mut count = 0;
    for triangle in 0..rig.collider.triangles().len() {
        let joint = rig.collider.joint_of(TriangleId(triangle as u32)).unwrap();
        let name = rig.skeleton.joints()[joint.index()].name.as_str();
        let wanted = name.starts_with("Tail") || name == "Head";
        assert_eq!(is_fur(&tail, triangle), wanted, "{name}");
        count += usize::from(wanted);
    }
    assert!(count > 50 && count < rig.collider.triangles().len() - 50);
    assert_eq!(rig.collider_materials.len(), 5);
    let green = with(json!({ "materials": ["Green", "Red"] })).unwrap();
    let wanted = |triangle: usize| {
        ["Green", "Red"].iter().any(|name| {
            let triangles = &rig.collider_materials[*name];
            triangles
                .binary_search(&TriangleId(triangle as u32))
                .is_ok()
        })
    };
    let all = 0..rig.collider.triangles().len();
    assert!(
        all.clone()
            .all(|triangle| is_fur(&green, triangle) == wanted(triangle))
    );
    assert!(all.clone().any(wanted) && !all.clone().all(wanted));
    // Each triangle has one material.
    let sum: usize = rig.collider_materials.values().map(Vec::len).sum();
    assert_eq!(sum, all.len());
    // Stone stays stone if `fur` lists its joint, and becomes fur if `fur` lists its material.
    let stone = rig.collider.with_tags(|triangle, tag| SurfaceTag {
        kind: if wanted(triangle.index()) {
            SurfaceKind::Stone
        } else {
            tag.kind
        },
        user: 7,
    });
    let mut stony = rig.clone();
    stony.collider = Arc::new(stone);
    let mut brain = trex();
    brain["body"]["fur"] = json!({ "joints": ["*"] });
    let kind = try_kind(&stony, &brain).unwrap();
    assert!(
        all.clone()
            .all(|triangle| is_fur(&kind, triangle) != wanted(triangle))
    );
    brain["body"]["fur"] = json!({ "joints": ["*"], "materials": ["Green", "Red"] });
    let kind = try_kind(&stony, &brain).unwrap();
    assert!(all.clone().all(|triangle| is_fur(&kind, triangle)));
    assert!(
        all.clone()
            .all(|triangle| kind.mesh().tags()[triangle].user == 7)
    );
    // The creature's own surface, on which climbers are, has this fur, too.
    let creature = Creature::new(kind, CreatureConfig::default()).unwrap();
    assert!(
        creature
            .surface()
            .mesh()
            .tags()
            .iter()
            .all(|tag| tag.kind == SurfaceKind::Fur)
    );
    for (fur, words) in [
        (json!({ "materials": ["green"] }), "material `green`"),
        (json!({ "joints": ["Wing.*"] }), "joint `Wing.*`"),
        (json!({ "joint": ["Tail1"] }), "unknown field `joint`"),
    ] {
        let error = with(fur).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
    let error = with(json!({ "materials": ["green"] })).unwrap_err();
    assert!(
        error.contains("Green") && error.contains("LightYellow"),
        "{error}"
    );
}

/// A clip whose channels begin and end at different times, with one channel for each interpolation.
fn ragged(joint: JointId) -> Clip {
    let vectors = |xs: &[f32]| xs.iter().map(|x| Vec3::splat(*x)).collect::<Vec<_>>();
    let turns = |angles: &[f32]| {
        angles
            .iter()
            .map(|angle| {
                Quat::from_xyzw(libm::sinf(angle / 2.0), 0.0, 0.0, libm::cosf(angle / 2.0))
            })
            .collect()
    };
    let linear = Channel::new(
        joint,
        Interpolation::Linear,
        vec![0.5, 1.0, 2.0],
        Keyframes::Translation(vectors(&[1.0, 2.0, 4.0])),
    );
    let step = Channel::new(
        joint,
        Interpolation::Step,
        vec![1.0, 3.0],
        Keyframes::Rotation(turns(&[0.1, 0.7])),
    );
    let spline = Channel::new(
        joint,
        Interpolation::CubicSpline,
        vec![0.75, 1.5, 2.5],
        Keyframes::Scale(vectors(&[9.0, 1.0, 0.5, 0.1, 1.2, 0.1, 0.3, 1.5, 9.0])),
    );
    let channels = [linear, step, spline].map(Result::unwrap).to_vec();
    Clip::new("ragged", channels)
}

#[test]
fn a_clip_that_is_closed_goes_back_to_its_beginning_and_is_as_before_until_then() {
    let Some(mut rig) = test_rig("Trex.glb") else {
        return;
    };
    let joint = rig.skeleton.find("Neck").unwrap();
    let marker = Marker {
        name: "snap".into(),
        time: 2.5,
    };
    let clip = ragged(joint).with_markers(vec![marker]).unwrap();
    let clip = clip.with_ground_speed(Some(1.5)).unwrap();
    rig.clips.push(clip.clone());
    let rest = rig.skeleton.rest_pose();
    for seconds in [1.0 / 24.0, 0.5, 10.0] {
        let mut brain = trex();
        brain["body"]["clips"]["ragged"] = json!({ "close": seconds });
        let kind = try_kind(&rig, &brain).unwrap();
        let closed = &kind.clips().clips()[rig.clips.len() - 1];
        let ends = clip.duration();
        assert!((closed.duration() - ends - seconds).abs() < 1e-6);
        assert_eq!(closed.markers(), clip.markers());
        assert_eq!(closed.ground_speed(), Some(1.5));
        let at = |clip: &Clip, time: f64| {
            let pose = clip.sample(&rest, time, Playback::Clamp).unwrap();
            pose.transforms[joint.index()]
        };
        let gap = |a: Transform, b: Transform| {
            let turn = a.rotation.angle_between(b.rotation);
            a.translation.distance(b.translation) + a.scale.distance(b.scale) + turn
        };
        for tick in 0..1_000 {
            let time = ends * f64::from(tick) / 1_000.0;
            let apart = gap(at(closed, time), at(&clip, time));
            assert!(apart < 1e-5, "at {time} s: {apart}");
        }
        assert!(gap(at(closed, 0.0), at(&clip, 0.0)) < 1e-6);
        assert!(gap(at(closed, ends), at(&clip, ends)) < 1e-3);
        assert!(gap(at(closed, closed.duration()), at(&clip, 0.0)) < 1e-6);
        // Half the closing time after the end, a linear channel is half way back, and a step channel has not changed.
        let half = at(closed, ends + 0.5 * seconds);
        assert!((half.translation.x - 2.5).abs() < 1e-4, "{half:?}");
        assert!(half.rotation.angle_between(at(&clip, ends).rotation) < 1e-3);
    }
}

#[test]
fn a_spline_of_rotations_closes_the_short_way() {
    let Some(mut rig) = test_rig("Trex.glb") else {
        return;
    };
    let joint = rig.skeleton.find("Neck").unwrap();
    let still = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let turn =
        |angle: f32| Quat::from_xyzw(libm::sinf(angle / 2.0), 0.0, 0.0, libm::cosf(angle / 2.0));
    // The two rotations are nearly equal, but the signs of their quaternions differ.
    let values = [still, turn(0.1), still, still, -turn(0.2), still].to_vec();
    let spline = Channel::new(
        joint,
        Interpolation::CubicSpline,
        vec![0.0, 1.0],
        Keyframes::Rotation(values),
    );
    rig.clips.push(Clip::new("sways", vec![spline.unwrap()]));
    let mut brain = trex();
    brain["body"]["clips"]["sways"] = json!({ "close": 0.5 });
    let kind = try_kind(&rig, &brain).unwrap();
    let closed = &kind.clips().clips()[rig.clips.len() - 1];
    for step in 0..=20 {
        let time = 1.0 + 0.5 * f64::from(step) / 20.0;
        let pose = closed
            .sample(&rig.skeleton.rest_pose(), time, Playback::Clamp)
            .unwrap();
        let angle = pose.transforms[joint.index()]
            .rotation
            .angle_between(turn(0.15));
        assert!(angle < 0.06, "at {time} s: {angle}");
    }
}

#[test]
fn a_clip_that_jumps_does_so_no_more_when_it_is_closed() {
    let Some(rig) = test_rig("Trex.glb") else {
        return;
    };
    // At the end of this clip the Trex lies on its back.
    let death = "Armature|TRex_Death";
    let seam = |close: Option<f64>| {
        let mut brain = trex();
        if let Some(close) = close {
            brain["body"]["clips"][death] = json!({ "close": close });
        }
        let kind = try_kind(&rig, &brain).unwrap();
        let clip = kind.clips().find(death).unwrap();
        let probe = SeamProbe::new(kind.skeleton(), kind.mesh(), kind.height());
        probe.measure(kind.clips().clip(clip).unwrap()).unwrap()
    };
    assert!(!seam(None).is_loop(), "{:?}", seam(None));
    assert!(seam(Some(0.5)).is_loop(), "{:?}", seam(Some(0.5)));
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let Some(rig) = test_rig("Trex.glb") else {
        return;
    };
    let changed = |pointer: &str, value: Value| {
        let mut file = trex();
        *file.pointer_mut(pointer).unwrap() = value;
        try_kind(&rig, &file).unwrap_err()
    };
    for (pointer, value, text) in [
        (
            "/body/clips",
            json!({ "Bite": {} }),
            "there is no clip `Bite`; there is `Armature|TRex_Attack`",
        ),
        (
            "/body/clips/Armature|TRex_Attack/markers/recovery",
            json!(9),
            "recovery",
        ),
        (
            "/body/clips/Armature|TRex_Attack/markers/active",
            json!(-1),
            "active",
        ),
        (
            "/body/weak_points/0/joint",
            json!("Nose"),
            "there is no joint `Nose`",
        ),
        ("/body/weak_points/0/radius", json!(-1), "`radius` is -1"),
        (
            "/body/weak_points/0/hit_points",
            json!(0),
            "`hit_points` is 0",
        ),
        ("/body/weak_points/0/at", json!([0, 99, 0]), "`at` is 99"),
        (
            "/body/clips/Armature|TRex_Attack",
            json!({ "marks": {} }),
            "unknown field `marks`",
        ),
        (
            "/body/clips/Armature|TRex_Attack",
            json!({ "close": 0 }),
            "`close` is 0",
        ),
        (
            "/body/clips/Armature|TRex_Attack",
            json!({ "close": 11 }),
            "`close` is 11",
        ),
    ] {
        let error = changed(pointer, value);
        assert!(error.contains(text), "{pointer}: {error}");
    }
    let mut file = trex();
    file["body"]["facing"] = json!("north");
    let error = try_kind(&rig, &file).unwrap_err();
    assert!(error.contains("`+z`, `-z`, `+x`, `-x`"), "{error}");
}

/// The rig as in a file whose model faces another way: everything is turned about Y.
fn turned(rig: &Rig, turn: Quat) -> Rig {
    let mut rig = rig.clone();
    let mut joints = rig.skeleton.joints().to_vec();
    let roots: Vec<bool> = joints.iter().map(|joint| joint.parent.is_none()).collect();
    for joint in joints.iter_mut().filter(|joint| joint.parent.is_none()) {
        joint.rest.rotation = turn * joint.rest.rotation;
        joint.rest.translation = turn * joint.rest.translation;
    }
    rig.skeleton = Skeleton::new(joints).unwrap();
    for clip in &mut rig.clips {
        let channels = clip.channels().iter().map(|channel| {
            let mut values = channel.values().clone();
            if roots[channel.joint().index()] {
                match &mut values {
                    Keyframes::Translation(all) => all.iter_mut().for_each(|v| *v = turn * *v),
                    Keyframes::Rotation(all) => all.iter_mut().for_each(|q| *q = turn * *q),
                    Keyframes::Scale(_) => {}
                }
            }
            let times = channel.times().to_vec();
            Channel::new(channel.joint(), channel.interpolation(), times, values).unwrap()
        });
        *clip = Clip::new(clip.name.clone(), channels.collect());
    }
    rig
}

/// A model that faces another way lives like one that faces +Z, if the brain's file says which way it faces.
#[test]
fn a_file_that_looks_another_way_lives_alike() {
    let Some(rig) = test_rig("Fox.glb") else {
        return;
    };
    let leg = |joints: [&str; 3]| json!({ "joints": joints });
    let brain = |facing: &str| {
        json!({
            "body": {
                "facing": facing, "height": 2, "made_for": 0.6,
                "legs": [
                    leg(["b_LeftUpperArm_09", "b_LeftForeArm_010", "b_LeftHand_011"]),
                    leg(["b_RightUpperArm_06", "b_RightForeArm_07", "b_RightHand_08"])
                ],
                "gait": { "idle": "Survey", "walk": "Walk", "turn_deg": 60, "steer_deg": 30 }
            },
            "start": "stands",
            "states": {
                "stands": { "transitions": [{ "to": "walks", "when": ["noise > 0"] }] },
                "walks": { "act": { "walk": { "to": "noise", "within": 1 } }, "transitions": [
                    { "to": "stands", "when": ["done"] }] }
            }
        })
    };
    let ahead = try_kind(&rig, &brain("+z")).unwrap();
    assert!(ahead.walks_aside().unwrap().abs() < 20.0);
    let terrain = level_ground();
    for (facing, turn) in [
        ("-z", std::f32::consts::PI),
        ("+x", std::f32::consts::FRAC_PI_2),
        ("-x", -std::f32::consts::FRAC_PI_2),
    ] {
        let half = 0.5 * f64::from(turn);
        let turn = Quat::from_xyzw(0.0, libm::sin(half) as f32, 0.0, libm::cos(half) as f32);
        let rig = turned(&rig, turn);
        // Without the right `facing`, the creature would not walk the way it faces, and `walks_aside` reports that.
        let untold = try_kind(&rig, &brain("+z"));
        if let Ok(untold) = &untold {
            let aside = untold.walks_aside().unwrap();
            assert!(aside.abs() > 45.0, "{facing}: {aside}");
        }
        let other = try_kind(&rig, &brain(facing)).unwrap();
        let mut creatures = [&ahead, &other]
            .map(|kind| Creature::new(Arc::clone(kind), CreatureConfig::default()).unwrap());
        for tick in 0..900u32 {
            let noises = [noise(DVec3::new(9.0, 0.0, 14.0))];
            let around = with_noises(&terrain, &noises[..usize::from(tick % 300 < 9)]);
            for creature in &mut creatures {
                creature.step(&around).unwrap();
            }
            let [a, b] = &creatures;
            let apart = a.state().position().distance(b.state().position());
            assert!(apart < 2e-3, "{facing}, tick {tick}: {apart}");
            let skins = [a, b].map(|creature| creature.surface().bounding_ball().unwrap());
            assert!(
                skins[0].0.distance(skins[1].0) < 5e-3,
                "{facing}, tick {tick}"
            );
        }
        assert!(creatures[0].state().position().length() > 8.0);
    }
}
