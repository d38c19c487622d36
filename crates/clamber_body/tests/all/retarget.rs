//! The hero's clips on other bodies.

use clamber_body::{Humanoid, Limb, LimbEnd, Retarget};
use clamber_scenes::test_data;
use clamber_surface::geometry::Affine;
use clamber_surface::rig::{
    Channel, Clip, Interpolation, Joint, JointId, Keyframes, Playback, Pose, Skeleton, Transform,
};
use glam::{DAffine3, DQuat, DVec3, Quat};

use crate::figures::hero_rig;

fn models(skeleton: &Skeleton, pose: &Pose) -> Vec<DAffine3> {
    let palette = skeleton.palette(pose).unwrap();
    let joints = 0..skeleton.joints().len() as u32;
    joints
        .map(|joint| *palette.model_from_joint(JointId(joint)).unwrap())
        .collect()
}

/// Directions of a limb's upper and lower bone, in model space.
fn bones(models: &[DAffine3], limb: &Limb) -> [DVec3; 2] {
    let place = |joint: JointId| models[joint.index()].translation;
    let tip = match limb.end {
        LimbEnd::Joint(joint) | LimbEnd::Beside(joint, _) => place(joint),
        LimbEnd::Point(point) => models[limb.lower.index()].transform_point3(point),
    };
    let elbow = place(limb.lower);
    [
        (elbow - place(limb.upper)).normalize(),
        (tip - elbow).normalize(),
    ]
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

#[test]
fn a_clip_on_its_own_body_is_itself() {
    let rig = hero_rig();
    let body = Humanoid::find(&rig.skeleton).unwrap();
    let same = Retarget::new((&rig.skeleton, &body), (&rig.skeleton, &body)).unwrap();
    let rest = rig.skeleton.rest_pose();
    for clip in &rig.clips {
        let carried = same.clip(clip).unwrap();
        assert_eq!(carried.name, clip.name);
        assert!(
            (carried.duration() - clip.duration()).abs() < 1e-6,
            "{}",
            clip.name
        );
        assert_eq!(
            carried.markers().len(),
            clip.markers().len(),
            "{}",
            clip.name
        );
        assert_eq!(carried.ground_speed(), clip.ground_speed(), "{}", clip.name);
        // The carried clip equals the original at its keys; between them it is linear.
        let count = (clip.duration() * 30.0).ceil() as usize;
        for key in [0, count / 3, count] {
            let time = clip.duration() * key as f64 / count as f64;
            let [a, b] = [clip, &carried]
                .map(|clip| clip.sample(&rest, time, Playback::Clamp).unwrap())
                .map(|pose| models(&rig.skeleton, &pose));
            for (role, joint) in body.joints() {
                let [a, b] = [&a, &b].map(|models| models[joint.index()]);
                let off = a.translation.distance(b.translation);
                assert!(off < 1e-4, "{} at {time}, {role}: {off} m", clip.name);
                let x = angle(a.matrix3.x_axis, b.matrix3.x_axis);
                assert!(x < 0.05, "{} at {time}, {role}: {x}°", clip.name);
            }
        }
    }
}

#[test]
fn limbs_of_other_bodies_point_where_the_heros_do() {
    let rig = hero_rig();
    let body = Humanoid::find(&rig.skeleton).unwrap();
    for name in ["Character", "George", "CesiumMan", "robot", "RiggedFigure"] {
        let Some(file) = test_data::file("retargeted clips", &format!("models/{name}.glb")) else {
            return;
        };
        let other = clamber_gltf::load(file).unwrap().rig;
        let found = Humanoid::find(&other.skeleton).unwrap();
        let retarget = Retarget::new((&rig.skeleton, &body), (&other.skeleton, &found)).unwrap();
        let turn = DQuat::from_rotation_arc(body.facing, found.facing);
        let mut worst = 0f64;
        let rest = rig.skeleton.rest_pose();
        let standing = [
            models(&rig.skeleton, &rest),
            models(&other.skeleton, &retarget.pose(&rest).unwrap()),
        ];
        for clip in &rig.clips {
            let carried = retarget.clip(clip).unwrap();
            for share in [0.0, 0.3, 0.7, 1.0] {
                let time = clip.duration() * share;
                let source = clip
                    .sample(&rig.skeleton.rest_pose(), time, Playback::Clamp)
                    .unwrap();
                let target = retarget.pose(&source).unwrap();
                let sampled = carried
                    .sample(&other.skeleton.rest_pose(), time, Playback::Clamp)
                    .unwrap();
                let [source, target, sampled] = [
                    models(&rig.skeleton, &source),
                    models(&other.skeleton, &target),
                    models(&other.skeleton, &sampled),
                ];
                let limbs = body.arms.iter().chain(&body.legs);
                for (from, to) in limbs.zip(found.arms.iter().chain(&found.legs)) {
                    let [a, b, c] = [
                        bones(&source, from),
                        bones(&target, to),
                        bones(&sampled, to),
                    ];
                    for bone in 0..2 {
                        let off = angle(turn * a[bone], b[bone]);
                        worst = worst.max(off);
                        assert!(
                            off < 1.0,
                            "{name}, {} at {time}: bone {bone} {off}°",
                            clip.name
                        );
                        // The carried clip has nearly the same pose between its keys.
                        let off = angle(b[bone], c[bone]);
                        assert!(off < 12.0, "{name}, {} at {time}: {off}°", clip.name);
                    }
                }
                // The hips bob as the hero's do, scaled by the length of the legs.
                let size = found.legs[0].length() / body.legs[0].length();
                let up = |models: &[DAffine3], hips: JointId| models[hips.index()].translation.y;
                let bob = up(&target, found.hips) - up(&standing[1], found.hips);
                let expected = (up(&source, body.hips) - up(&standing[0], body.hips)) * size;
                assert!(
                    (bob - expected).abs() < 0.02 * size,
                    "{name}, {}: {bob} {expected}",
                    clip.name
                );
            }
        }
        println!("{name}: limbs within {worst:.3}°");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let rig = hero_rig();
    let body = Humanoid::find(&rig.skeleton).unwrap();
    let mut joints = rig.skeleton.joints()[..1].to_vec();
    joints[0].parent = None;
    let small = Skeleton::new(joints).unwrap();
    assert!(Retarget::new((&small, &body), (&rig.skeleton, &body)).is_err());
    assert!(Retarget::new((&rig.skeleton, &body), (&small, &body)).is_err());
    let same = Retarget::new((&rig.skeleton, &body), (&rig.skeleton, &body)).unwrap();
    assert!(same.pose(&small.rest_pose()).is_err());

    // A very long clip has no more keys than a clip of an hour.
    let still = Keyframes::Rotation(vec![Quat::IDENTITY; 2]);
    let channel = Channel::new(body.head, Interpolation::Linear, vec![0.0, 1e30], still).unwrap();
    let carried = same.clip(&Clip::new("ages", vec![channel])).unwrap();
    assert_eq!(carried.channels()[0].times().len(), 108_001);
}

/// A skeleton may be a chain of any length, in any order. It does not overflow the stack.
#[test]
fn a_long_chain_of_joints_is_no_trouble() {
    let rig = hero_rig();
    let mut joints = rig.skeleton.joints().to_vec();
    let hips = rig.skeleton.find("hips").unwrap();
    let first = joints.len() as u32;
    let links = 20_000;
    for link in 0..links {
        let next = first + link + 1;
        joints.push(Joint {
            name: format!("link {link}"),
            parent: (link + 1 < links).then_some(JointId(next)),
            rest: Transform::IDENTITY,
            inverse_bind: Affine::IDENTITY,
        });
    }
    joints[hips.index()].parent = Some(JointId(first));
    let skeleton = Skeleton::new(joints).unwrap();
    assert!(Humanoid::find(&skeleton).is_ok());
}
