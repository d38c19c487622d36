//! Arms and legs: scenes B01 to B09.

use clamber_animation::glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use clamber_animation::ik::{
    IkError, PoleMemory, ReachResult, TwoBone, TwoBoneGoal, bend, soft_distance,
};
use clamber_animation::rig::{JointId, Pose, Skeleton, Transform};
use clamber_surface::geometry::{rotation_from_axis_angle, rotation_vector};

use crate::common::{angle, joint, place, random, unit};

/// The upper joint, the lower joint and the end of the limb of [`arm`].
const JOINTS: [JointId; 3] = [JointId(1), JointId(2), JointId(3)];

/// A body with one arm along X, slightly bent, whose elbow points to -Z.
fn arm(lengths: [f32; 2], root: Transform) -> Skeleton {
    let mut body = joint(None, Vec3::ZERO);
    body.rest = root;
    let mut upper = joint(Some(0), Vec3::new(0.2, 1.4, 0.0));
    upper.rest.rotation = rotation_from_axis_angle(DVec3::Y, 0.05).as_quat();
    let mut lower = joint(Some(1), Vec3::X * lengths[0]);
    lower.rest.rotation = rotation_from_axis_angle(DVec3::Y, -0.1).as_quat();
    let hand = joint(Some(2), Vec3::X * lengths[1]);
    Skeleton::new(vec![body, upper, lower, hand]).unwrap()
}

fn limb(skeleton: &Skeleton) -> TwoBone {
    TwoBone::new(skeleton, JOINTS, DVec3::NEG_Z).unwrap()
}

/// Moves the end of the limb of [`arm`], without a memory.
fn solve(skeleton: &Skeleton, pose: &mut Pose, goal: &TwoBoneGoal) -> ReachResult {
    let reach = limb(skeleton).solve(skeleton, pose, goal, None);
    reach.unwrap()
}

/// A target with a pole.
fn towards(target: DVec3, pole: DVec3) -> TwoBoneGoal {
    TwoBoneGoal {
        pole: Some(pole),
        ..TwoBoneGoal::reach(target)
    }
}

fn shoulder(skeleton: &Skeleton, pose: &Pose) -> DVec3 {
    place(skeleton, pose, 1)
}

/// The angle between two rotations.
fn apart(a: Quat, b: Quat) -> f64 {
    let turn = a.as_dquat().normalize() * b.as_dquat().normalize().conjugate();
    rotation_vector(turn).length()
}

#[test]
fn b01_reachable_targets_are_reached_and_bones_keep_their_lengths() {
    let mut rng = fastrand::Rng::with_seed(1);
    let mut worst = [0f64; 3];
    for _ in 0..100_000 {
        let lengths = [0.2 + rng.f64(), 0.2 + rng.f64()];
        let full = lengths[0] + lengths[1];
        let nearest = (lengths[0] - lengths[1]).abs();
        let distance = nearest + (full - nearest) * rng.f64();
        let target = unit(&mut rng) * distance;
        let found = bend(lengths, target, random(&mut rng, 1.0), 1.0, 0.0);
        assert_eq!(found.reach, ReachResult::Reached, "{lengths:?} {target}");
        worst[0] = worst[0].max(found.end.distance(target) / full);
        let bones = [found.elbow.length(), found.elbow.distance(found.end)];
        for (bone, length) in bones.into_iter().zip(lengths) {
            worst[1] = worst[1].max((bone - length).abs() / full);
        }
    }
    assert!(worst[0] <= 1e-6 && worst[1] <= 1e-6, "{worst:?}");

    // Here rotations are rounded to f32, and the body has an arbitrary transform.
    for _ in 0..20_000 {
        let lengths = [0.2 + rng.f32(), 0.2 + rng.f32()];
        let root = Transform {
            translation: random(&mut rng, 1.0).as_vec3(),
            rotation: crate::common::rotation(&mut rng).as_quat(),
            scale: Vec3::splat(0.5 + rng.f32()),
        };
        let skeleton = arm(lengths, root);
        let mut pose = skeleton.rest_pose();
        let full = f64::from((lengths[0] + lengths[1]) * root.scale.x);
        let nearest = f64::from((lengths[0] - lengths[1]).abs() * root.scale.x);
        let distance = nearest + (full - nearest) * (0.001 + 0.998 * rng.f64());
        let limb =
            TwoBone::new(&skeleton, JOINTS, root.rotation.as_dquat() * DVec3::NEG_Z).unwrap();
        let target = shoulder(&skeleton, &pose) + unit(&mut rng) * distance;
        let goal = towards(target, random(&mut rng, 1.0));
        let reach = limb.solve(&skeleton, &mut pose, &goal, None).unwrap();
        assert_eq!(reach, ReachResult::Reached, "{lengths:?} {target}");
        let end = place(&skeleton, &pose, 3);
        worst[2] = worst[2].max(end.distance(target) / full);
    }
    assert!(worst[2] <= 1e-5, "{worst:?}");
}

#[test]
fn b02_far_targets_are_aimed_at_with_the_soft_length() {
    let mut rng = fastrand::Rng::with_seed(2);
    for _ in 0..20_000 {
        let skeleton = arm([0.3, 0.25], Transform::IDENTITY);
        let mut pose = skeleton.rest_pose();
        let from = shoulder(&skeleton, &pose);
        let full = 0.55;
        let direction = unit(&mut rng);
        let distance = full * (1.0 + 2.0 * rng.f64());
        let goal = TwoBoneGoal {
            soft: 0.97,
            ..towards(from + direction * distance, random(&mut rng, 1.0))
        };
        let reach = solve(&skeleton, &mut pose, &goal);
        let way = place(&skeleton, &pose, 3) - from;
        assert!(
            matches!(reach, ReachResult::Short(gap) if gap > 0.0),
            "{reach:?}"
        );
        let aim = angle(way, direction);
        assert!(aim <= 1e-4, "{aim}");
        // The formula of the reference: d' = r L + (1 - r) L (1 - e^(-(d - r L) / ((1 - r) L))).
        let room = 0.03 * full;
        let soft = 0.97 * full + room * (1.0 - libm::exp(-(distance - 0.97 * full) / room));
        let length = way.length();
        assert!((length - soft).abs() <= 1e-5 * full, "{length} {soft}");
    }
}

#[test]
fn b03_impossible_input_gives_typed_errors_or_a_finite_pose() {
    let skeleton = arm([0.3, 0.3], Transform::IDENTITY);
    let limb = limb(&skeleton);
    let rest = skeleton.rest_pose();
    let solve = |pose: &mut Pose, goal: &TwoBoneGoal| limb.solve(&skeleton, pose, goal, None);
    let check = |pose: &Pose| {
        for transform in &pose.transforms {
            let length = transform.rotation.as_dquat().length();
            assert!((length - 1.0).abs() < 1e-6, "{pose:?}");
        }
    };
    // A target on the shoulder, and poles that give no side.
    let on_shoulder = shoulder(&skeleton, &rest);
    for target in [
        on_shoulder,
        on_shoulder + DVec3::X * 1e-300,
        on_shoulder + DVec3::X * 0.3,
    ] {
        for pole in [
            None,
            Some(DVec3::ZERO),
            Some(DVec3::X),
            Some(DVec3::Y * 1e-300),
        ] {
            let mut pose = rest.clone();
            let goal = TwoBoneGoal {
                pole,
                ..TwoBoneGoal::reach(target)
            };
            solve(&mut pose, &goal).unwrap();
            check(&pose);
            let end = place(&skeleton, &pose, 3);
            assert!(end.distance(target) < 1e-5, "{target} {pole:?}: {end}");
        }
    }
    // Numbers that are not finite, and softness out of range.
    let fine = TwoBoneGoal::reach(DVec3::ONE);
    let nan = TwoBoneGoal::reach(DVec3::NAN);
    let no_pole = towards(DVec3::ONE, DVec3::INFINITY);
    let mut pose = rest.clone();
    for (goal, what) in [(nan, "the target"), (no_pole, "the pole")] {
        assert_eq!(solve(&mut pose, &goal), Err(IkError::NotFinite(what)));
    }
    for soft in [0.0, -1.0, 1.1, f64::NAN] {
        let goal = TwoBoneGoal { soft, ..fine };
        assert!(matches!(solve(&mut pose, &goal), Err(IkError::BadSetUp(_))));
    }
    assert_eq!(pose, rest);
    // Bones and scales of 0.
    type Break = fn(&mut Transform);
    let [a, b, c] = JOINTS;
    let no_length: Break = |t| t.translation = Vec3::ZERO;
    let broken: [(usize, Break, IkError); 4] = [
        (2, no_length, IkError::NoLength(b)),
        (3, no_length, IkError::NoLength(c)),
        (0, |t| t.scale.y = 0.0, IkError::NotInvertible(a)),
        (1, |t| t.scale = Vec3::ZERO, IkError::NotInvertible(b)),
    ];
    for (index, change, expected) in broken {
        let mut pose = rest.clone();
        change(&mut pose.transforms[index]);
        let before = pose.clone();
        assert_eq!(solve(&mut pose, &fine), Err(expected), "joint {index}");
        assert_eq!(pose, before);
    }
    let mut pose = rest.clone();
    pose.transforms[2].rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert_eq!(solve(&mut pose, &fine), Err(IkError::NotFinite("the pose")));
    pose.transforms.pop();
    let cut = solve(&mut pose, &fine);
    assert!(matches!(cut, Err(IkError::NoJoint { .. })));
    // A limb of another skeleton.
    let mut body = joint(None, Vec3::ZERO);
    body.rest.translation = Vec3::Y;
    let small = Skeleton::new(vec![body]).unwrap();
    let foreign = limb.solve(&small, &mut small.rest_pose(), &fine, None);
    assert!(matches!(foreign, Err(IkError::NoJoint { joints: 1, .. })));
    assert!(limb.end(&small, &small.rest_pose()).is_err());
    assert!(limb.lengths(&small, &small.rest_pose()).is_err());
    // Joints that do not form a limb.
    let new = |joints| TwoBone::new(&skeleton, joints, DVec3::NEG_Z);
    for bad in [
        [a, a, c],
        [a, b, b],
        [c, b, a],
        [a, c, b],
        [a, b, JointId(9)],
    ] {
        assert!(new(bad).is_err(), "{bad:?}");
    }
    assert!(TwoBone::new(&skeleton, JOINTS, DVec3::ZERO).is_err());
    assert!(TwoBone::new(&skeleton, JOINTS, DVec3::NAN).is_err());
}

/// The largest angular speed of the elbow, radians per second, while a hand recedes at 1 m/s from 0.8 to 1.1 of the
/// arm's length. Frames are sampled at several phases.
fn fastest_elbow(soft: f64) -> f64 {
    let phases = (0..16).map(|phase| elbow_speed(soft, f64::from(phase) / 16.0));
    phases.fold(0.0, f64::max)
}

fn elbow_speed(soft: f64, phase: f64) -> f64 {
    let (length, rate) = (0.45, 240.0);
    let full = 2.0 * length;
    let (mut last, mut fastest) = (None, 0f64);
    let ticks = (0.3 * full * rate) as i32;
    for tick in 0..=ticks {
        let distance = 0.8 * full + (f64::from(tick) + phase) / rate;
        let found = bend([length; 2], DVec3::X * distance, DVec3::Y, soft, 0.0);
        let angle = angle(found.elbow, found.end - found.elbow);
        if let Some(last) = last {
            fastest = fastest.max(f64::abs(angle - last) * rate);
        }
        last = Some(angle);
    }
    fastest
}

#[test]
fn b04_a_receding_hand_does_not_snap_the_elbow_straight() {
    let soft = fastest_elbow(0.97);
    assert!(soft <= 9.3, "{soft}");
    // The control: an arm without softness.
    let hard = fastest_elbow(1.0);
    assert!(hard > 30.0, "{hard}");
}

/// Checks a map of distances for four faults: it is not monotone, reaches beyond the target, is steeper than 1, or its
/// slope jumps.
fn faults(map: impl Fn(f64) -> f64) -> [bool; 4] {
    let (step, mut found) = (1e-4, [false; 4]);
    let slope = |d: f64| (map(d + step) - map(d)) / step;
    let mut last = slope(0.0);
    for k in 1..40_000 {
        let d = f64::from(k) * step;
        let now = slope(d);
        found[0] |= now < -1e-9;
        found[1] |= map(d) > d + 1e-9;
        found[2] |= now > 1.0 + 1e-6;
        // The slope itself changes by at most 1 / (1 - r) per length.
        found[3] |= (now - last).abs() > 1e-3 + step / 0.03;
        last = now;
    }
    found
}

#[test]
fn b05_the_soft_map_is_smooth_and_never_beyond_its_target() {
    assert_eq!(faults(|d| soft_distance(d, 1.0, 0.97)), [false; 4]);
    // The control: a map with a fourth power, whose slope at the start is 4/3.
    let quartic = |d: f64| {
        let alpha = ((d - 0.97) / 0.03).max(0.0);
        let fourth = (alpha + 3.0) * (alpha + 3.0) * (alpha + 3.0) * (alpha + 3.0);
        if d < 0.97 {
            d
        } else {
            0.97 + 0.03 * (1.0 - 81.0 / fourth)
        }
    };
    let [_, beyond, steep, _] = faults(quartic);
    assert!(beyond && steep);
    // A second control: a map whose slope jumps.
    let hard = |d: f64| d.min(1.0);
    assert!(faults(hard)[3]);
}

#[test]
fn b06_an_elbow_does_not_flip_where_the_hand_passes_its_pole() {
    for offset in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        for rate in [30.0, 60.0, 240.0] {
            let skeleton = arm([0.3, 0.3], Transform::IDENTITY);
            let mut pose = skeleton.rest_pose();
            let from = shoulder(&skeleton, &pose);
            let (mut memory, mut last) = (PoleMemory::default(), None);
            let mut worst = 0f64;
            // Three circles with a radius of 0.4 m at 1 m/s, which pass near the pole's axis, which is up.
            let ticks = (3.0 * core::f64::consts::TAU * 0.4 * rate) as i32;
            for tick in 0..ticks {
                let turn = f64::from(tick) / (0.4 * rate);
                let direction = DVec3::new(libm::cos(turn), libm::sin(turn), offset).normalize();
                let goal = towards(from + direction * 0.4, DVec3::Y);
                limb(&skeleton)
                    .solve(&skeleton, &mut pose, &goal, Some((&mut memory, 1.0 / rate)))
                    .unwrap();
                assert!(place(&skeleton, &pose, 3).distance(goal.target) < 1e-5);
                let elbow = place(&skeleton, &pose, 2) - from;
                let side = (elbow - direction * elbow.dot(direction)).normalize();
                if let Some((was, side_was)) = last {
                    // The rotation of the limb's plane about the limb, without the limb's own rotation.
                    let carried: DVec3 = DQuat::from_rotation_arc(was, direction) * side_was;
                    worst = worst.max(angle(carried, side));
                }
                last = Some((direction, side));
            }
            let most = 15f64.to_radians() * (60.0 / rate).max(1.0);
            assert!(
                worst <= most,
                "{offset} at {rate} Hz: {}",
                worst.to_degrees()
            );
        }
    }
    // The control: without a memory the elbow flips.
    let [a, b] = [1e-4, -1e-4].map(|x| {
        let direction = DVec3::new(x, 1.0, 0.0).normalize() * 0.4;
        bend([0.3; 2], direction, DVec3::Y, 1.0, 0.0).elbow
    });
    assert!((a - b).length() > 0.4);
}

#[test]
fn b07_mirrored_limbs_are_mirrored_and_mirrored_rigs_reach() {
    let mut rng = fastrand::Rng::with_seed(7);
    let mirror = DVec3::new(-1.0, 1.0, 1.0);
    let right = arm([0.3, 0.25], Transform::IDENTITY);
    // The same arm on the other side: positions are mirrored, rotations about X are kept, all others are reversed.
    let mut joints = right.joints().to_vec();
    for joint in &mut joints {
        joint.rest.translation.x *= -1.0;
        let q = joint.rest.rotation;
        joint.rest.rotation = Quat::from_xyzw(q.x, -q.y, -q.z, q.w);
    }
    let left = Skeleton::new(joints).unwrap();
    let mirrored = Transform {
        scale: Vec3::new(-1.0, 1.0, 1.0),
        ..Transform::IDENTITY
    };
    let scaled = arm([0.3, 0.25], mirrored);
    for _ in 0..5_000 {
        let target = DVec3::new(0.2, 1.4, 0.0) + unit(&mut rng) * (0.06 + 0.48 * rng.f64());
        let pole = random(&mut rng, 1.0);
        let solve = |skeleton: &Skeleton, target, pole| {
            let mut pose = skeleton.rest_pose();
            let reach = self::solve(skeleton, &mut pose, &towards(target, pole));
            assert_eq!(reach, ReachResult::Reached);
            let [elbow, hand] = [2, 3].map(|k| place(skeleton, &pose, k));
            assert!(hand.distance(target) < 1e-5, "{target} {hand}");
            (elbow, hand, pose)
        };
        let (elbow, hand, pose) = solve(&right, target, pole);
        let (elbow_left, hand_left, pose_left) = solve(&left, target * mirror, pole * mirror);
        assert!((elbow * mirror).distance(elbow_left) <= 1e-6);
        assert!((hand * mirror).distance(hand_left) <= 1e-6);
        for (a, b) in pose.transforms.iter().zip(&pose_left.transforms) {
            let q = a.rotation;
            let q = Quat::from_xyzw(q.x, -q.y, -q.z, q.w);
            // The rotations themselves are equal up to the rounding of f32.
            assert!(apart(q, b.rotation) <= 4e-7, "{q} {}", b.rotation);
        }
        let (elbow_scaled, ..) = solve(&scaled, target * mirror, pole * mirror);
        assert!((elbow * mirror).distance(elbow_scaled) < 1e-5);
    }
    // Before rounding the difference is at most 1e-7.
    for _ in 0..20_000 {
        let (target, pole) = (random(&mut rng, 0.4), random(&mut rng, 1.0));
        let [a, b] =
            [DVec3::ONE, mirror].map(|by| bend([0.3, 0.25], target * by, pole * by, 0.97, 0.1));
        assert!((a.elbow * mirror).distance(b.elbow) <= 1e-7);
        assert!((a.end * mirror).distance(b.end) <= 1e-7);
    }
}

#[test]
fn b08_a_parent_that_scales_unevenly_is_exact_and_a_joint_that_does_is_refused() {
    let mut rng = fastrand::Rng::with_seed(8);
    let uneven = Transform {
        scale: Vec3::new(1.0, 2.0, 0.5),
        rotation: rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7).as_quat(),
        ..Transform::IDENTITY
    };
    let skeleton = arm([0.3, 0.3], uneven);
    let parent = DMat3::from_quat(uneven.rotation.as_dquat())
        * DMat3::from_diagonal(uneven.scale.as_dvec3());
    for _ in 0..5_000 {
        let mut pose = skeleton.rest_pose();
        let target =
            shoulder(&skeleton, &pose) + parent * (unit(&mut rng) * (0.01 + 0.58 * rng.f64()));
        let reach = solve(&skeleton, &mut pose, &TwoBoneGoal::reach(target));
        assert_eq!(reach, ReachResult::Reached);
        let end = place(&skeleton, &pose, 3);
        assert!(end.distance(target) <= 1e-3, "{}", end.distance(target));
    }
    let mut pose = arm([0.3, 0.3], Transform::IDENTITY).rest_pose();
    pose.transforms[1].scale = Vec3::new(1.0, 2.0, 0.5);
    let skeleton = arm([0.3, 0.3], Transform::IDENTITY);
    let refused =
        limb(&skeleton).solve(&skeleton, &mut pose, &TwoBoneGoal::reach(DVec3::ONE), None);
    assert_eq!(refused, Err(IkError::Sheared(JointId(2))));
}

#[test]
fn b09_a_solved_pose_is_kept() {
    let mut rng = fastrand::Rng::with_seed(9);
    for k in 0..5_000 {
        let skeleton = arm([0.3, 0.25], Transform::IDENTITY);
        let mut pose = skeleton.rest_pose();
        if k % 2 == 0 {
            for index in [1, 2] {
                let turn = crate::common::rotation(&mut rng);
                pose.transforms[index].rotation = turn.as_quat();
            }
        }
        let from = shoulder(&skeleton, &pose);
        let goal = TwoBoneGoal {
            pole: (k % 3 == 0).then(|| random(&mut rng, 1.0)),
            ..TwoBoneGoal::reach(from + unit(&mut rng) * (0.08 + 0.44 * rng.f64()))
        };
        solve(&skeleton, &mut pose, &goal);
        let once = pose.clone();
        solve(&skeleton, &mut pose, &goal);
        let pairs = once.transforms.iter().zip(&pose.transforms);
        for (a, b) in pairs {
            assert!(apart(a.rotation, b.rotation) <= 2e-6, "{goal:?}");
        }
        // A limb whose end is already at the target keeps its pose, however it was bent.
        let end = place(&skeleton, &pose, 3);
        solve(&skeleton, &mut pose, &TwoBoneGoal::reach(end));
        for (a, b) in once.transforms.iter().zip(&pose.transforms) {
            assert!(apart(a.rotation, b.rotation) <= 2e-3, "{goal:?}");
        }
    }
}

#[test]
fn an_elbow_does_not_fold_beyond_its_limit() {
    let skeleton = arm([0.3, 0.25], Transform::IDENTITY);
    let limb = limb(&skeleton).with_least_angle(0.6).unwrap();
    let mut pose = skeleton.rest_pose();
    let target = shoulder(&skeleton, &pose) + DVec3::X * 0.06;
    let reach = limb.solve(&skeleton, &mut pose, &TwoBoneGoal::reach(target), None);
    let [a, b, c] = [1, 2, 3].map(|k| place(&skeleton, &pose, k));
    let folded = angle(a - b, c - b);
    assert!((folded - 0.6).abs() < 1e-5, "{folded}");
    let off = a.distance(c) - 0.06;
    assert!(matches!(reach, Ok(ReachResult::TooNear(by)) if (by - off).abs() < 1e-5));
    for angle in [-0.1, 3.2, f64::NAN] {
        assert!(limb.with_least_angle(angle).is_err());
    }
}

#[test]
fn a_limb_may_end_at_a_point_of_its_lower_bone() {
    let mut rng = fastrand::Rng::with_seed(10);
    let skeleton = arm([0.3, 0.25], Transform::IDENTITY);
    let tip = DVec3::new(0.2, 0.02, -0.05);
    let joints = [JointId(1), JointId(2)];
    let limb = TwoBone::to_point(&skeleton, joints, tip, DVec3::NEG_Z).unwrap();
    for _ in 0..1_000 {
        let mut pose = skeleton.rest_pose();
        let from = shoulder(&skeleton, &pose);
        let target = from + unit(&mut rng) * (0.12 + 0.38 * rng.f64());
        let goal = TwoBoneGoal::reach(target);
        let reach = limb.solve(&skeleton, &mut pose, &goal, None).unwrap();
        assert_eq!(reach, ReachResult::Reached);
        let end = limb.end(&skeleton, &pose).unwrap();
        let palette = skeleton.palette(&pose).unwrap();
        let elbow = palette.model_from_joint(JointId(2)).unwrap();
        assert!(end.distance(target) < 1e-5 && elbow.transform_point3(tip).distance(target) < 1e-5);
    }
    assert!(TwoBone::to_point(&skeleton, joints, DVec3::NAN, DVec3::NEG_Z).is_err());
    assert!(TwoBone::to_point(&skeleton, joints, DVec3::ZERO, DVec3::NEG_Z).is_err());
}

/// A clip may overstretch an elbow a little. The elbow still bends the right way, and the arm does not twist.
#[test]
fn an_overstretched_elbow_bends_the_right_way() {
    let skeleton = arm([0.3, 0.25], Transform::IDENTITY);
    for overstretch in [0.002, 0.02, 0.2] {
        let mut pose = skeleton.rest_pose();
        let turn = rotation_from_axis_angle(DVec3::Y, overstretch);
        pose.transforms[2].rotation = turn.as_quat();
        let before = pose.transforms[1].rotation;
        let from = shoulder(&skeleton, &pose);
        let target = from + (place(&skeleton, &pose, 3) - from) * 0.99;
        solve(&skeleton, &mut pose, &TwoBoneGoal::reach(target));
        let elbow = place(&skeleton, &pose, 2) - from;
        assert!(elbow.z < -0.01, "{overstretch}: {elbow}");
        let turned = apart(before, pose.transforms[1].rotation);
        assert!(turned < 0.4, "{overstretch}: {turned}");
    }
}
