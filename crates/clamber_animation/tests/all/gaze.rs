//! Heads that look at a target: scenes B10 and B11.

use clamber_animation::glam::{DQuat, DVec3, Vec3};
use clamber_animation::ik::{Chain, IkError, LookAt, LookMemory, ReachResult, aim, orient};
use clamber_animation::rig::{JointId, Pose, Skeleton};
use clamber_animation::{joint_in_model, joints_in_model};
use clamber_surface::geometry::{rotation_from_axis_angle, rotation_vector};

use crate::common::{angle, frame, joint, place};

/// The head of [`torso`].
const HEAD: JointId = JointId(4);

/// Upright hips, two spine joints, neck and head; the head looks along +Z.
fn torso() -> Skeleton {
    let up = Vec3::Y * 0.15;
    let hips = joint(None, Vec3::Y);
    let above = (0..4).map(|parent| joint(Some(parent), up));
    Skeleton::new(std::iter::once(hips).chain(above).collect()).unwrap()
}

fn look(skeleton: &Skeleton) -> LookAt {
    let chain = [(HEAD, 0.5), (JointId(3), 0.5), (JointId(2), 1.0)];
    let eye = DVec3::new(0.0, 0.1, 0.08);
    LookAt::new(skeleton, &chain, eye, DVec3::Z, DVec3::Y).unwrap()
}

/// The eye's position and its viewing direction, in model space.
fn gaze(skeleton: &Skeleton, pose: &Pose) -> [DVec3; 2] {
    let head = frame(skeleton, pose, HEAD);
    let eye = head.transform_point3(DVec3::new(0.0, 0.1, 0.08));
    [eye, head.transform_vector3(DVec3::Z).normalize()]
}

fn at(yaw: f64, pitch: f64, distance: f64) -> DVec3 {
    let level = DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw)) * libm::cos(pitch);
    DVec3::Y * 1.7 + (level + DVec3::Y * libm::sin(pitch)) * distance
}

#[test]
fn b10_the_gaze_arrives_and_half_a_weight_is_half_the_turn() {
    let skeleton = torso();
    let look = look(&skeleton);
    for yaw in [-70, -30, 0, 10, 45, 75].map(|deg| f64::from(deg).to_radians()) {
        for pitch in [-50, -20, 0, 30, 55].map(|deg| f64::from(deg).to_radians()) {
            let target = at(yaw, pitch, 5.0);
            let mut last = f64::INFINITY;
            let mut whole = 0.0;
            for k in 0..=20 {
                let weight = f64::from(k) / 20.0;
                let solve = |negated: bool| {
                    let mut pose = skeleton.rest_pose();
                    for transform in &mut pose.transforms {
                        // The same rotation with the other sign.
                        if negated {
                            transform.rotation = -transform.rotation;
                        }
                    }
                    let mut memory = LookMemory::default();
                    look.solve(&skeleton, &mut pose, target, weight, &mut memory, 0.1)
                        .unwrap();
                    pose
                };
                let [a, b] = [false, true].map(solve);
                let [eye, seen] = gaze(&skeleton, &a);
                let other = gaze(&skeleton, &b)[1];
                assert!((seen - other).length() < 1e-6, "{yaw} {pitch} {weight}");
                // The angle to the target falls monotonically with the weight.
                let left = angle(seen, target - eye);
                let told = format_args!("{yaw} {pitch} {weight}: {left}");
                assert!(left <= last + 1e-6, "{told} after {last}");
                last = left;
                if k == 0 {
                    whole = angle(DVec3::Z, target - eye);
                }
                if k == 10 {
                    let off = (left - whole / 2.0).abs();
                    assert!(off <= 0.05 * whole + 1e-3, "{left} of {whole}");
                }
            }
            assert!(last < 1e-4, "{yaw} {pitch}: {last} left");
        }
    }
}

#[test]
fn mirrored_and_scaled_bodies_look_where_they_should() {
    let look_up = |scale: Vec3, turn: DQuat| {
        let mut joints = torso().joints().to_vec();
        joints[0].rest.scale = scale;
        joints[0].rest.rotation = turn.as_quat();
        let skeleton = Skeleton::new(joints).unwrap();
        let chain = [(HEAD, 0.5), (JointId(3), 0.5), (JointId(2), 1.0)];
        let eye = DVec3::new(0.0, 0.1, 0.08);
        let up = turn * DVec3::Y;
        let look = LookAt::new(&skeleton, &chain, eye, DVec3::Z, up).unwrap();
        let target = turn * (DVec3::new(2.0, 0.6, 4.0) * scale.as_dvec3().signum()) + DVec3::Y;
        let mut pose = skeleton.rest_pose();
        let mut memory = LookMemory::default();
        let left = look.solve(&skeleton, &mut pose, target, 1.0, &mut memory, 0.1);
        let left = left.unwrap();
        assert!(left < 1e-4, "{scale} {turn}: {left}");
        let [eye, seen] = gaze(&skeleton, &pose);
        assert!(angle(seen, target - eye) < 1e-4, "{scale} {turn}");
        // `aim` points both axes of a head in the right directions as well.
        let directions = [DVec3::new(0.3, 0.2, 1.0), DVec3::new(-0.1, 1.0, 0.0)];
        aim(&skeleton, &mut pose, HEAD, [DVec3::Z, DVec3::Y], directions).unwrap();
        let head = frame(&skeleton, &pose, HEAD).matrix3;
        let off = angle(head * DVec3::Z, directions[0]);
        assert!(off < 1e-5, "{scale} {turn}: {off}");
        let across = directions[0].cross(directions[1]);
        assert!((head * DVec3::Y).dot(across).abs() < 1e-5, "{scale} {turn}");
        assert!((head * DVec3::Y).dot(directions[1]) > 0.0, "{scale} {turn}");
    };
    let mut rng = fastrand::Rng::with_seed(12);
    for scale in [
        Vec3::ONE,
        Vec3::splat(7.0),
        Vec3::new(-1.0, 1.0, 1.0),
        Vec3::new(2.0, 2.0, -2.0),
    ] {
        look_up(scale, DQuat::IDENTITY);
        for _ in 0..50 {
            look_up(scale, crate::common::rotation(&mut rng));
        }
    }
    // A head that is mirrored itself.
    let mut pose = torso().rest_pose();
    pose.transforms[4].scale = Vec3::new(-1.0, 1.0, 1.0);
    let directions = [DVec3::new(0.3, 0.2, 1.0), DVec3::NEG_Y];
    aim(&torso(), &mut pose, HEAD, [DVec3::X, DVec3::Y], directions).unwrap();
    let head = frame(&torso(), &pose, HEAD).matrix3;
    assert!(angle(head * DVec3::X, directions[0]) < 1e-5 && (head * DVec3::Y).y < 0.0);

    let mut pose = torso().rest_pose();
    pose.transforms[1].scale = Vec3::new(1.0, 2.0, 1.0);
    let mut aimed = |joint, axes| aim(&torso(), &mut pose, joint, axes, [DVec3::X, DVec3::Y]);
    let sheared = aimed(HEAD, [DVec3::Z, DVec3::Y]);
    assert!(matches!(sheared, Err(IkError::Sheared(_))), "{sheared:?}");
    let found = aimed(JointId(0), [DVec3::Z, DVec3::Z]);
    assert!(matches!(found, Err(IkError::BadSetUp(_))), "{found:?}");
}

/// A pose of the torso with random rotations, and with a scale on one of its joints.
fn scaled_pose(rng: &mut fastrand::Rng, scaled: usize, scale: Vec3) -> Pose {
    let mut pose = torso().rest_pose();
    for transform in &mut pose.transforms {
        transform.rotation = crate::common::rotation(rng).as_quat();
    }
    pose.transforms[scaled].scale = scale;
    pose
}

#[test]
fn joints_are_oriented_below_any_parents() {
    let mut rng = fastrand::Rng::with_seed(21);
    for scale in [1.0, 3.0, 1.0000002, -1.0] {
        for scaled in 0..5 {
            for _ in 0..40 {
                let mut pose = scaled_pose(&mut rng, scaled, Vec3::splat(scale));
                let wanted = crate::common::rotation(&mut rng);
                orient(&torso(), &mut pose, HEAD, wanted).unwrap();
                let head = joint_in_model(&torso(), &pose, HEAD).unwrap().matrix3;
                for axis in [DVec3::Y, DVec3::Z] {
                    let off = angle(head * axis, wanted * axis);
                    assert!(off < 1e-6, "{scale} at {scaled}: {off}");
                }
            }
        }
    }
    let before = scaled_pose(&mut rng, 1, Vec3::new(1.0, 2.0, 1.0));
    let mut pose = before.clone();
    let wrong = [
        (JointId(9), DQuat::IDENTITY),
        (HEAD, DQuat::IDENTITY),
        (JointId(0), DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)),
        (JointId(0), DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
    ];
    for (joint, rotation) in wrong {
        let refused = orient(&torso(), &mut pose, joint, rotation);
        assert!(refused.is_err(), "{joint} {rotation}");
        assert_eq!(pose, before);
    }
}

#[test]
fn frames_of_several_joints_are_those_of_each() {
    let mut rng = fastrand::Rng::with_seed(22);
    for scale in [Vec3::ONE, Vec3::new(1.0, -2.0, 0.5)] {
        for _ in 0..300 {
            let scaled = rng.usize(..5);
            let pose = scaled_pose(&mut rng, scaled, scale);
            // Joints in any order, also repeated.
            let joints = [(); 4].map(|()| JointId(rng.u32(..5)));
            let together = joints_in_model(&torso(), &pose, joints).unwrap();
            for (joint, frame) in joints.into_iter().zip(together) {
                let alone = joint_in_model(&torso(), &pose, joint).unwrap();
                let same = frame.abs_diff_eq(alone, 1e-12);
                assert!(same, "{joints:?}: {frame} {alone}");
            }
        }
    }
    let pose = torso().rest_pose();
    assert!(joints_in_model(&torso(), &pose, [HEAD, JointId(5)]).is_none());
    assert!(joints_in_model(&torso(), &Pose::default(), [HEAD]).is_none());
}

#[test]
fn a_look_at_chain_has_a_most_length() {
    let column = |count: u32| {
        let up = Vec3::Y * 0.1;
        let joints = (0..count).map(|index| joint(index.checked_sub(1), up));
        let skeleton = Skeleton::new(joints.collect()).unwrap();
        let chain = [(JointId(count - 1), 0.5), (JointId(0), 1.0)];
        LookAt::new(&skeleton, &chain, DVec3::ZERO, DVec3::Z, DVec3::Y)
    };
    assert!(column(256).is_ok());
    assert!(matches!(column(257), Err(IkError::BadSetUp(_))));
}

#[test]
fn b10_limits_hold_and_a_target_behind_changes_the_side_once_a_second() {
    let skeleton = torso();
    let look = look(&skeleton);
    for speed in [1.0, 3.0, 10.0, 40.0] {
        let (rate, mut memory) = (60.0, LookMemory::default());
        let (mut side, mut since, mut changes) = (0.0, 10.0, 0);
        for tick in 0..1200 {
            // The target circles, and then swings to and fro behind the body.
            let time = f64::from(tick) / rate;
            let yaw = if tick < 600 {
                time * speed
            } else {
                core::f64::consts::PI + 0.6 * libm::sin(time * speed)
            };
            let mut pose = skeleton.rest_pose();
            let (target, dt) = (at(yaw, 0.2, 8.0), 1.0 / rate);
            look.solve(&skeleton, &mut pose, target, 1.0, &mut memory, dt)
                .unwrap();
            let seen = gaze(&skeleton, &pose)[1];
            let yaw_seen = libm::atan2(seen.x, seen.z);
            let degrees = yaw_seen.abs().to_degrees();
            assert!(degrees <= 80.5, "{degrees}");
            since += 1.0 / rate;
            // The head looks over a shoulder here.
            if yaw_seen.abs() > 79f64.to_radians() {
                if side != 0.0 && side != yaw_seen.signum() {
                    // Through the front the gaze may change the side at any time.
                    let front = libm::cos(yaw) > 0.17;
                    if !front && speed < 30.0 {
                        assert!(
                            since >= 0.99 || tick < 600,
                            "after {since} s, in tick {tick} at {speed} rad/s"
                        );
                    }
                    changes += 1;
                    since = 0.0;
                }
                side = yaw_seen.signum();
            }
        }
        assert!(changes > 0 || speed > 3.0, "{speed}");
    }
    let up = {
        let mut pose = skeleton.rest_pose();
        let (high, mut memory) = (at(0.0, 1.5, 8.0), LookMemory::default());
        look.solve(&skeleton, &mut pose, high, 1.0, &mut memory, 0.1)
            .unwrap();
        gaze(&skeleton, &pose)[1]
    };
    // The eye moves as the head turns, which changes the pitch by a degree and a half here.
    let pitch = angle(up, DVec3::Z).to_degrees();
    assert!((57.0..=60.1).contains(&pitch), "{pitch}");
}

#[test]
fn b11_a_head_stays_where_it_looks_while_the_body_sways() {
    // A body with a neck of five bones, bent like a swan's.
    let bend = [0.9, -0.7, -0.6, 0.5, 0.4];
    let mut joints = vec![joint(None, Vec3::Y * 2.0)];
    for (index, angle) in bend.into_iter().enumerate() {
        let mut next = joint(Some(index as u32), Vec3::Y * 0.4);
        next.rest.rotation = rotation_from_axis_angle(DVec3::X, angle).as_quat();
        joints.push(next);
    }
    joints.push(joint(Some(5), Vec3::Y * 0.4));
    let skeleton = Skeleton::new(joints).unwrap();
    let head = JointId(6);
    let neck = Chain::new(&skeleton, JointId(1), head).unwrap();
    let rest = skeleton.rest_pose();
    let home = place(&skeleton, &rest, 6);
    let target = DVec3::new(0.0, 2.0, 30.0);
    let sway = |tick: u32| {
        let phase = f64::from(tick) / 60.0 * core::f64::consts::TAU;
        let mut pose = rest.clone();
        let body = &mut pose.transforms[0];
        body.translation += (DVec3::X * (0.3 * libm::sin(phase))).as_vec3();
        let turn = rotation_from_axis_angle(DVec3::Z, 20f64.to_radians() * libm::sin(phase));
        body.rotation = turn.as_quat();
        pose
    };
    let rotation = |pose: &Pose| {
        let head = frame(&skeleton, pose, head);
        head.to_scale_rotation_translation().1
    };
    let (mut first, mut control) = (None, 0f64);
    for tick in 0..120 {
        let mut pose = sway(tick);
        control = control.max(place(&skeleton, &pose, 6).distance(home));
        // The neck chain brings the head to its place first, then the head aims at the target.
        let reach = neck.solve(&skeleton, &mut pose, home).unwrap();
        assert_eq!(reach, ReachResult::Reached);
        let to_target = target - place(&skeleton, &pose, 6);
        let axes = [DVec3::Z, DVec3::Y];
        aim(&skeleton, &mut pose, head, axes, [to_target, DVec3::Y]).unwrap();
        let moved = place(&skeleton, &pose, 6).distance(home);
        assert!(moved <= 0.02, "{moved} m in tick {tick}");
        let now = rotation(&pose);
        let first = *first.get_or_insert(now);
        let turned = rotation_vector(now * first.conjugate()).length();
        let turned = turned.to_degrees();
        assert!(turned <= 1.0, "{turned}° in tick {tick}");
    }
    assert!(control > 0.3, "without it the head moves {control} m");
}

#[test]
fn chains_reach_what_they_can_and_say_what_they_cannot() {
    let skeleton = torso();
    let chain = Chain::new(&skeleton, JointId(0), HEAD).unwrap();
    let rest = skeleton.rest_pose();
    let mut rng = fastrand::Rng::with_seed(6);
    for _ in 0..2_000 {
        // The chain is straight at rest; some targets lie on its line.
        let from = DVec3::Y;
        let target = match rng.u32(0..4) {
            0 => from + DVec3::Y * (0.6 * rng.f64()),
            _ => from + crate::common::unit(&mut rng) * (0.02 + 0.57 * rng.f64()),
        };
        let mut pose = rest.clone();
        let reach = chain.solve(&skeleton, &mut pose, target).unwrap();
        let off = chain.end(&skeleton, &pose).unwrap().distance(target);
        match reach {
            ReachResult::Reached => assert!(off < 2e-4, "{target}: {off}"),
            ReachResult::Short(gap) | ReachResult::TooNear(gap) => {
                assert!((gap - off).abs() < 1e-4, "{target}: {off} {gap}");
                assert!(off < 0.05, "{target}: {off} {gap}");
            }
        }
        for pair in [[0, 1], [1, 2], [2, 3], [3, 4]] {
            let [a, b] = pair.map(|k| place(&skeleton, &pose, k));
            assert!((a.distance(b) - 0.15).abs() < 1e-6);
        }
    }
    let mut pose = rest.clone();
    let far = chain.solve(&skeleton, &mut pose, DVec3::new(2.0, 1.0, 0.0));
    let is_short = matches!(far, Ok(ReachResult::Short(gap)) if (gap - 1.4).abs() < 1e-4);
    assert!(is_short, "{far:?}");
    assert!(chain.solve(&skeleton, &mut pose, DVec3::NAN).is_err());
    let mut wild = rest.clone();
    wild.transforms[HEAD.index()].translation.x = f32::NAN;
    let end = chain.end(&skeleton, &wild);
    assert_eq!(end, Err(IkError::NotFinite("the pose")));
    assert!(Chain::new(&skeleton, HEAD, JointId(0)).is_err());
    assert!(Chain::new(&skeleton, HEAD, HEAD).is_err());
    assert!(Chain::new(&skeleton, JointId(0), JointId(9)).is_err());
}

#[test]
fn gazes_that_make_no_sense_are_refused() {
    let skeleton = torso();
    let new = |chain: &[(JointId, f64)], forward, up| {
        LookAt::new(&skeleton, chain, DVec3::ZERO, forward, up).err()
    };
    let head = [(HEAD, 1.0)];
    assert_eq!(new(&head, DVec3::Z, DVec3::Y), None);
    assert!(new(&[], DVec3::Z, DVec3::Y).is_some());
    assert!(new(&head, DVec3::ZERO, DVec3::Y).is_some());
    assert!(new(&head, DVec3::Z, DVec3::Z).is_some());
    assert!(new(&head, DVec3::Z, DVec3::NAN).is_some());
    assert!(new(&[(HEAD, 2.0)], DVec3::Z, DVec3::Y).is_some());
    assert!(new(&[(JointId(9), 1.0)], DVec3::Z, DVec3::Y).is_some());
    assert!(new(&[(JointId(1), 0.5), (HEAD, 1.0)], DVec3::Z, DVec3::Y).is_some());
    let look = look(&skeleton);
    let mut pose = skeleton.rest_pose();
    for (target, weight) in [(DVec3::NAN, 1.0), (DVec3::Z, f64::NAN)] {
        let mut memory = LookMemory::default();
        let found = look.solve(&skeleton, &mut pose, target, weight, &mut memory, 0.1);
        let wanted = IkError::NotFinite("a target or a weight");
        assert_eq!(found, Err(wanted), "{target} {weight}");
    }
}
