//! Bodies in files: the project's hero and third-party characters.

use clamber_animation::ik::{ReachResult, TwoBoneGoal};
use clamber_body::{BodyError, HumanJoint, Humanoid, Limb, LimbEnd, Retarget, Side};
use clamber_scenes::test_data;
use clamber_surface::mesh::Rig;
use clamber_surface::rig::{JointId, Pose};
use glam::DVec3;

use crate::figures::hero_rig;

fn load(name: &str) -> Option<Rig> {
    let file = test_data::file("bodies", &format!("models/{name}.glb"))?;
    Some(clamber_gltf::load(file).unwrap().rig)
}

/// The name of a joint.
fn name(rig: &Rig, joint: JointId) -> &str {
    &rig.skeleton.joints()[joint.index()].name
}

/// Each limb reaches a point at 0.8 of its length and keeps the lengths of its bones.
fn check_limbs(rig: &Rig, body: &Humanoid) {
    let rest = rig.skeleton.rest_pose();
    let palette = rig.skeleton.palette(&rest).unwrap();
    for limb in body.arms.iter().chain(&body.legs) {
        let shoulder = palette.model_from_joint(limb.upper).unwrap().translation;
        let end = limb.ik.end(&rig.skeleton, &rest).unwrap();
        let length = end.distance(shoulder);
        for toward in [body.facing, DVec3::NEG_Y, (end - shoulder).normalize()] {
            let target = shoulder + toward * (0.8 * length);
            let mut pose = rest.clone();
            let goal = TwoBoneGoal::reach(target);
            let reach = limb
                .ik
                .solve(&rig.skeleton, &mut pose, &goal, None)
                .unwrap();
            assert_eq!(reach, ReachResult::Reached, "{}", name(rig, limb.upper));
            let off = limb.ik.end(&rig.skeleton, &pose).unwrap().distance(target);
            assert!(off < 1e-5 * length, "{}: {off}", name(rig, limb.upper));
        }
    }
}

#[test]
fn the_hero_has_a_whole_body_and_clips_with_markers() {
    let rig = hero_rig();
    let body = Humanoid::find(&rig.skeleton).unwrap();
    assert_eq!(body.joints().len(), 4 + 2 * 8);
    assert_eq!(
        (name(&rig, body.hips), name(&rig, body.chest())),
        ("hips", "chest")
    );
    assert!(body.facing.distance(DVec3::Z) < 1e-6);
    for side in Side::BOTH {
        let (arm, leg) = (body.arm(side), body.leg(side));
        assert_eq!(arm.fingers.len(), 3, "{:?}", arm.fingers);
        assert!(arm.fingers.iter().all(|finger| finger.len() == 2));
        assert!((0.45..0.65).contains(&arm.length()) && (0.75..0.95).contains(&leg.length()));
    }
    check_limbs(&rig, &body);
    // In each locomotion clip both feet step once, at the clip's ground speed.
    for (clip, speed) in [
        ("walk", 1.4),
        ("run", 4.0),
        ("walk_back", 1.2),
        ("strafe_left", 1.2),
    ] {
        let clip = rig.clip(clip).unwrap();
        let mut steps: Vec<&str> = clip
            .markers()
            .iter()
            .map(|marker| marker.name.as_str())
            .collect();
        steps.sort_unstable();
        assert_eq!(steps, ["step_left", "step_right"], "{}", clip.name);
        let found = clip.ground_speed().unwrap();
        assert!((found - speed).abs() < 1e-6, "{}: {found} m/s", clip.name);
    }
    for (clip, marker) in [("stab_strike", "hit"), ("swing", "hit"), ("loose", "loose")] {
        let clip = rig.clip(clip).unwrap();
        assert!(
            clip.markers().iter().any(|found| found.name == marker),
            "{}",
            clip.name
        );
    }
}

#[test]
fn bodies_are_found_in_files_of_many_tools() {
    // The file, the names of hips, chest, left hand and left foot, and the number of fingers.
    let expected = [
        ("Character", "Body", "Chest", Some("Hand.L"), "Foot.L", 0),
        ("robot", "Body", "Torso", None, "Foot.L", 4),
        ("George", "Body", "Neck", None, "Foot.L", 4),
        (
            "CesiumMan",
            "Skeleton_torso_joint_1",
            "torso_joint_3",
            Some("Skeleton_arm_joint_L__2_"),
            "leg_joint_L_3",
            0,
        ),
        (
            "RiggedFigure",
            "torso_joint_1",
            "torso_joint_3",
            Some("arm_joint_L_3"),
            "leg_joint_L_3",
            0,
        ),
    ];
    for (file, hips, chest, hand, foot, fingers) in expected {
        let Some(rig) = load(file) else { return };
        let body = Humanoid::find(&rig.skeleton).unwrap_or_else(|error| panic!("{file}: {error}"));
        let arm = body.arm(Side::Left);
        let found = (name(&rig, body.hips), name(&rig, body.chest()));
        assert_eq!(found, (hips, chest), "{file}");
        assert_eq!(
            arm.end.joint().map(|joint| name(&rig, joint)),
            hand,
            "{file}"
        );
        assert_eq!(
            body.leg(Side::Left)
                .end
                .joint()
                .map(|joint| name(&rig, joint)),
            Some(foot),
            "{file}"
        );
        assert_eq!(arm.fingers.len(), fingers, "{file}: {:?}", arm.fingers);
        // In their bind poses all bodies face +Z. At rest, Character is in a fighting pose.
        assert!(
            body.facing.distance(DVec3::Z) < 0.05,
            "{file}: {}",
            body.facing
        );
        check_limbs(&rig, &body);
        // Left and right limbs have nearly the same length; the robot's upper arms differ by an eighth.
        for [left, right] in [&body.arms, &body.legs] {
            assert!(
                (left.length() - right.length()).abs() < 0.04 * left.length(),
                "{file}"
            );
        }
        // `from_joints` finds the same body, except for hands that are not joints.
        if hand.is_some() {
            let by_hand = Humanoid::from_joints(&rig.skeleton, &body.joints()).unwrap();
            assert_eq!(by_hand, body, "{file}");
        }
    }
}

#[test]
fn feet_beside_the_legs_are_found_where_the_shins_end() {
    let Some(rig) = load("Character") else { return };
    let body = Humanoid::find(&rig.skeleton).unwrap();
    for leg in &body.legs {
        let LimbEnd::Beside(_, point) = leg.end else {
            panic!("{:?}", leg.end);
        };
        let palette = rig.skeleton.palette(&rig.skeleton.rest_pose()).unwrap();
        let shin = palette.model_from_joint(leg.lower).unwrap();
        let length = shin.transform_vector3(point).length();
        assert!(
            (length - leg.lengths[1]).abs() < 1e-4,
            "{length} {:?}",
            leg.lengths
        );
        assert!(leg.lengths[1] > 0.2 * leg.lengths[0], "{:?}", leg.lengths);
    }
}

#[test]
fn files_without_a_whole_body_are_refused_with_what_they_lack() {
    let both = |joint: fn(Side) -> HumanJoint| Side::BOTH.map(joint);
    let cases: [(&str, Vec<HumanJoint>); 3] = [
        ("godot_platformer_player", both(HumanJoint::Hand).to_vec()),
        (
            "Leela",
            [
                both(HumanJoint::UpperArm),
                both(HumanJoint::LowerArm),
                both(HumanJoint::Hand),
            ]
            .concat(),
        ),
        ("greenman", both(HumanJoint::UpperArm).to_vec()),
    ];
    for (file, lacks) in cases {
        let Some(rig) = load(file) else { return };
        let Err(BodyError::Missing(missing)) = Humanoid::find(&rig.skeleton) else {
            panic!("{file} has a body");
        };
        for joint in lacks {
            assert!(missing.contains(&joint), "{file} lacks {missing:?}");
        }
        let text = BodyError::Missing(missing).to_string();
        assert!(text.contains("left "), "{text}");
    }
}

/// A file whose joints are called `Bone.001` and so on has a body once a list names them.
#[test]
fn joints_without_names_are_named_by_hand() {
    let Some(rig) = load("tnua_player") else {
        return;
    };
    assert!(matches!(
        Humanoid::find(&rig.skeleton),
        Err(BodyError::Missing(_))
    ));
    use HumanJoint::{Foot, Hand, Head, Hips, LowerArm, LowerLeg, UpperArm, UpperLeg};
    let joint = |name: &str| rig.skeleton.find(name).unwrap();
    let mut joints = vec![(Hips, joint("Bone.003")), (Head, joint("Bone.002"))];
    let limbs = [
        (
            Side::Right,
            ["Bone.005", "Bone.006", "Bone.007"],
            ["Bone.014", "Bone.015", "Bone.016"],
        ),
        (
            Side::Left,
            ["Bone.009", "Bone.010", "Bone.011"],
            ["Bone.018", "Bone.019", "Bone.020"],
        ),
    ];
    for (side, arm, leg) in limbs {
        let [upper, lower, hand] = arm.map(joint);
        let [thigh, shin, foot] = leg.map(joint);
        joints.extend([
            (UpperArm(side), upper),
            (LowerArm(side), lower),
            (Hand(side), hand),
        ]);
        joints.extend([
            (UpperLeg(side), thigh),
            (LowerLeg(side), shin),
            (Foot(side), foot),
        ]);
    }
    let body = Humanoid::from_joints(&rig.skeleton, &joints).unwrap();
    check_limbs(&rig, &body);
    // The body faces -Z, as is usual in its engine, and its origin is at its waist. With the clips of another body it
    // stands at a height of 0.
    assert!(body.facing.z < -0.999, "{}", body.facing);
    let hero = hero_rig();
    let own = Humanoid::find(&hero.skeleton).unwrap();
    let retarget = Retarget::new((&hero.skeleton, &own), (&rig.skeleton, &body)).unwrap();
    let rest = retarget.pose(&hero.skeleton.rest_pose()).unwrap();
    for (leg, heros) in body.legs.iter().zip(&own.legs) {
        let height = |leg: &Limb, rig: &Rig, pose: &Pose| {
            leg.ik.end(&rig.skeleton, pose).unwrap().y / leg.length()
        };
        let ankle = height(leg, &rig, &rest);
        let wanted = height(heros, &hero, &hero.skeleton.rest_pose());
        assert!((ankle - wanted).abs() < 0.05, "{ankle}, {wanted}");
    }

    // Wrong lists are refused.
    type Joints = Vec<(HumanJoint, JointId)>;
    let refused = |change: &dyn Fn(&mut Joints)| {
        let mut joints = joints.clone();
        change(&mut joints);
        Humanoid::from_joints(&rig.skeleton, &joints).unwrap_err()
    };
    let error = refused(&|joints| joints.truncate(3));
    assert!(
        matches!(&error, BodyError::Missing(missing) if missing.len() == 11),
        "{error}"
    );
    let error = refused(&|joints| joints[1].1 = joints[0].1);
    assert_eq!(error, BodyError::Twice { what: Head });
    let error = refused(&|joints| joints[1].1.0 = 99);
    assert!(
        matches!(error, BodyError::NoJoint { what: Head, .. }),
        "{error}"
    );
    let error = refused(&|joints| {
        let lower = joints[3].1;
        joints[3].1 = joints[2].1;
        joints[2].1 = lower;
    });
    let above = UpperArm(Side::Right);
    assert_eq!(
        error,
        BodyError::NotBelow {
            what: LowerArm(Side::Right),
            above
        }
    );
}
