//! Layers, markers, root motion, and bad input.

use clamber_animation::glam::{DAffine3, DQuat, DVec3, Quat, Vec3};
use clamber_animation::rig::{Clip, Interpolation, JointId, Keyframes, Marker, Pose, Skeleton};
use clamber_animation::{
    AnimationError, AnimationEvent, AnimationSet, Animator, ClipId, JointMask, Layer, LayerKind,
    MaskId, PoseBuffers, RootDelta,
};
use clamber_surface::geometry::rotation_from_axis_angle;

use crate::common::{advance, channel, joint, pose};

/// Three joints in a row: hips, chest, head.
fn skeleton() -> Skeleton {
    let up = Vec3::Y * 0.5;
    Skeleton::new(vec![
        joint(None, up),
        joint(Some(0), up),
        joint(Some(1), up),
    ])
    .unwrap()
}

fn turn(axis: DVec3, angle: f64) -> Quat {
    rotation_from_axis_angle(axis, angle).as_quat()
}

/// A clip of 1 s that turns each joint about an axis, from one angle to another.
fn turning(name: &str, axis: DVec3, from: f64, to: f64) -> Clip {
    let channels = (0..3).map(|joint| {
        let values = Keyframes::Rotation(vec![turn(axis, from), turn(axis, to)]);
        channel(joint, Interpolation::Linear, &[0.0, 1.0], values)
    });
    Clip::new(name, channels.collect())
}

fn set() -> AnimationSet {
    let clips = vec![
        turning("nod", DVec3::X, 0.0, 0.4),
        turning("lean", DVec3::Z, 0.2, 0.2),
        turning("shiver", DVec3::Y, 0.1, 0.3),
    ];
    AnimationSet::new(&skeleton(), clips).unwrap()
}

/// A layer that plays a clip from a time on.
fn from(clip: u32, time: f64) -> Layer {
    Layer {
        time,
        ..Layer::new(ClipId(clip))
    }
}

/// The pose of a single layer.
fn alone(set: &AnimationSet, layer: Layer) -> Pose {
    pose(set, &Animator::new(vec![layer]))
}

/// The clip of [`walk_in_a_circle`], whose walk is root motion.
fn walk() -> AnimationSet {
    let set = AnimationSet::new(&skeleton(), vec![walk_in_a_circle()]).unwrap();
    set.with_root_motion(&skeleton(), JointId(0)).unwrap()
}

fn assert_turn(found: Quat, expected: DQuat) {
    let apart = (found.as_dquat() * expected.conjugate())
        .to_scaled_axis()
        .length();
    assert!(apart < 1e-6, "{found} is not {expected}");
}

#[test]
fn layers_override_by_weight_and_mask_and_add_differences() {
    let (set, skeleton) = (&mut set(), skeleton());
    let [nod, lean, shiver] = ["nod", "lean", "shiver"].map(|name| set.find(name).unwrap());
    let mask = JointMask::branch(&skeleton, JointId(1)).unwrap();
    let mask = mask.with_branch(&skeleton, JointId(2), 0.5).unwrap();
    assert_eq!(mask.shares(), [0.0, 1.0, 0.5]);
    let mask = set.add_mask(mask).unwrap();
    let about = rotation_from_axis_angle;

    let halfway = Layer {
        time: 0.5,
        speed: 0.0,
        ..Layer::new(nod)
    };
    let over = Layer {
        weight: 0.5,
        mask: Some(mask),
        ..Layer::new(lean)
    };
    let found = pose(set, &Animator::new(vec![halfway, over]));
    assert_turn(found.transforms[0].rotation, about(DVec3::X, 0.2));
    // Half way from 0.2 about X to 0.2 about Z.
    let middle = (about(DVec3::X, 0.2) + about(DVec3::Z, 0.2)).normalize();
    assert_turn(found.transforms[1].rotation, middle);

    // An additive layer adds the difference from the clip's first frame, in the joint's own space.
    let added = Layer {
        kind: LayerKind::Additive,
        time: 0.5,
        ..Layer::new(shiver)
    };
    let found = pose(set, &Animator::new(vec![halfway, added]));
    let expected = about(DVec3::X, 0.2) * about(DVec3::Y, 0.1);
    assert_turn(found.transforms[2].rotation, expected);
    let nothing = Layer {
        weight: 0.0,
        ..added
    };
    let found = pose(set, &Animator::new(vec![halfway, nothing]));
    assert_eq!(found, alone(set, halfway));
}

#[test]
fn a_larger_creature_is_slower_by_the_root_of_its_size() {
    let set = set();
    let mut animator = Animator::new(vec![Layer::new(ClipId(0))]);
    animator.set_scale(4.0).unwrap();
    advance(&mut animator, &set, 1.0);
    assert_eq!(animator.layers()[0].time, 0.5);
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(animator.set_scale(scale).is_err(), "{scale}");
    }
    assert_eq!(animator.rate(), 0.5);
}

/// Indices of the markers in events, in their order.
fn told(events: &[AnimationEvent]) -> Vec<usize> {
    let marker = |event: &AnimationEvent| match event {
        AnimationEvent::Marker { marker, .. } => Some(*marker),
        AnimationEvent::Ended { .. } => None,
    };
    events.iter().filter_map(marker).collect()
}

#[test]
fn markers_are_told_once_and_in_order_however_time_is_cut() {
    let times = [0.0, 0.25, 0.25, 0.6, 1.0];
    let markers = times.map(|time| Marker {
        name: format!("at {time}"),
        time,
    });
    let clip = turning("steps", DVec3::X, 0.0, 1.0)
        .with_markers(markers.to_vec())
        .unwrap();
    let set = AnimationSet::new(&skeleton(), vec![clip]).unwrap();
    let mut rng = fastrand::Rng::with_seed(3);
    for _ in 0..300 {
        let mut animator = Animator::new(vec![Layer::new(ClipId(0))]);
        let mut events = Vec::new();
        let mut passed = 0.0;
        while passed < 5.75 {
            let dt = f64::min(rng.f64() * 0.3, 5.75 - passed);
            animator.advance(&set, dt, &mut events).unwrap();
            passed += dt;
        }
        let expected: Vec<usize> = (0..29).map(|marker| marker % 5).collect();
        assert_eq!(told(&events), expected);
    }
    // Played backwards, the markers come in reverse order.
    let mut animator = Animator::new(vec![Layer {
        speed: -1.0,
        ..from(0, 0.7)
    }]);
    let mut events = Vec::new();
    for _ in 0..16 {
        animator.advance(&set, 0.1, &mut events).unwrap();
    }
    assert_eq!(told(&events), [3, 2, 1, 0, 4, 3, 2, 1]);
    // A step of more than one loop reports each marker once.
    for dt in [1e9, 1.3] {
        animator = Animator::new(vec![from(0, 0.5)]);
        events.clear();
        animator.advance(&set, dt, &mut events).unwrap();
        assert_eq!(told(&events), [3, 4, 0, 1, 2], "{dt} s");
    }
    assert!((animator.layers()[0].time - 0.8).abs() < 1e-12);

    // A clip that is played once ends once, and holds.
    let mut animator = Animator::new(vec![Layer::once(ClipId(0))]);
    events.clear();
    for _ in 0..30 {
        animator.advance(&set, 0.1, &mut events).unwrap();
    }
    assert_eq!(told(&events), [0, 1, 2, 3, 4]);
    let ended = AnimationEvent::Ended {
        layer: 0,
        clip: ClipId(0),
    };
    assert_eq!(events.iter().filter(|event| **event == ended).count(), 1);
    assert_eq!(animator.layers()[0].time, 1.0);
}

/// A clip of 1 s in which the hips walk a quarter of a circle with a radius of 2 m, and move up and down.
fn walk_in_a_circle() -> Clip {
    let keys = 33;
    let times: Vec<f32> = (0..keys).map(|k| k as f32 / (keys - 1) as f32).collect();
    let angle = |t: f32| f64::from(t) * core::f64::consts::FRAC_PI_2;
    let place = |t: &f32| {
        let a = angle(*t);
        let bob = 0.9 + 0.05 * libm::sin(a * 8.0);
        // From (0.3, 0.1), around a centre to the left, which is at X + 2.
        let (x, z) = (0.3 + 2.0 - 2.0 * libm::cos(a), 0.1 + 2.0 * libm::sin(a));
        DVec3::new(x, bob, z).as_vec3()
    };
    let heading = |t: &f32| turn(DVec3::Y, angle(*t));
    let places = Keyframes::Translation(times.iter().map(place).collect());
    let headings = Keyframes::Rotation(times.iter().map(heading).collect());
    let channels = [places, headings].map(|v| channel(0, Interpolation::Linear, &times, v));
    Clip::new("circle", channels.into())
}

fn matrix(motion: &RootDelta) -> DAffine3 {
    let turn = rotation_from_axis_angle(DVec3::Y, motion.yaw);
    DAffine3::from_rotation_translation(turn, motion.translation)
}

#[test]
fn root_motion_moves_the_creature_as_the_clip_did() {
    let skeleton = skeleton();
    let set = AnimationSet::new(&skeleton, vec![walk_in_a_circle()]).unwrap();
    let plain = set.clone();
    let set = set.with_root_motion(&skeleton, JointId(0)).unwrap();
    let mut rng = fastrand::Rng::with_seed(4);
    let mut animator = Animator::new(vec![Layer::new(ClipId(0))]);
    let (mut world_from_model, mut time) = (DAffine3::IDENTITY, 0.0f64);
    let whole = matrix(&advance(&mut animator.clone(), &set, 0.999_999_999));
    for _ in 0..400 {
        let dt = rng.f64() * 0.05;
        let motion = advance(&mut animator, &set, dt);
        assert_eq!(motion.translation.y, 0.0);
        world_from_model *= matrix(&motion);
        time += dt;
        // The hips' position in the plain clip: after all whole loops and the rest of the last one.
        let mut at = DAffine3::IDENTITY;
        for _ in 0..time as usize {
            at *= whole;
        }
        let expected = alone(&plain, from(0, time.fract())).transforms[0].to_affine();
        let found = pose(&set, &animator).transforms[0].to_affine();
        let (found, expected) = (world_from_model * found, at * expected);
        let off = (found.translation - expected.translation).length();
        assert!(off < 1e-4, "{off} m at {time} s");
        let turned = (found.matrix3.x_axis - expected.matrix3.x_axis).length();
        assert!(turned < 1e-4, "{turned} at {time} s");
    }
    // Without root motion, the hips stay over their place.
    let hips = pose(&set, &animator).transforms[0].translation;
    let off = (hips - Vec3::new(0.3, hips.y, 0.1)).abs();
    assert!(off.max_element() < 1e-5, "{hips}");
    assert!(world_from_model.translation.length() > 1.0);
}

/// An additive layer adds the difference of two whole poses of its clip, also under root motion. Joints that the clip
/// does not move get no change.
#[test]
fn an_additive_layer_adds_the_difference_of_whole_poses() {
    let skeleton = skeleton();
    let idle = turning("idle", DVec3::X, 0.1, 0.7);
    let clips = vec![idle, walk_in_a_circle()];
    let moving = AnimationSet::new(&skeleton, clips.clone()).unwrap();
    let sets = [
        moving.clone(),
        moving.with_root_motion(&skeleton, JointId(0)).unwrap(),
    ];
    let mut rng = fastrand::Rng::with_seed(8);
    for set in &sets {
        for _ in 0..200 {
            let (time, weight) = (rng.f64() * 3.0, rng.f64());
            let below = from(0, rng.f64());
            let added = Layer {
                kind: LayerKind::Additive,
                weight,
                ..from(1, time)
            };
            let found = pose(set, &Animator::new(vec![below, added]));
            let [base, first, sampled] =
                [below, from(1, 0.0), from(1, time)].map(|layer| alone(set, layer));
            for joint in 0..3 {
                let [found, base, first, sampled] =
                    [&found, &base, &first, &sampled].map(|pose| pose.transforms[joint]);
                let way = (sampled.translation - first.translation) * weight as f32;
                let place = base.translation + way;
                assert!(found.translation.distance(place) < 1e-5, "{joint}");
                let turn = first.rotation.as_dquat().conjugate() * sampled.rotation.as_dquat();
                let turn = clamber_surface::geometry::slerp(DQuat::IDENTITY, turn, weight);
                assert_turn(found.rotation, base.rotation.as_dquat() * turn);
            }
        }
    }
}

#[test]
fn a_layer_that_is_held_over_a_walk_stops_its_motion() {
    let set = walk();
    let walk = Layer::new(ClipId(0));
    let moved = |weight: f64| {
        let held = Layer {
            speed: 0.0,
            weight,
            ..walk
        };
        let mut animator = Animator::new(vec![walk, held]);
        advance(&mut animator, &set, 0.1).translation.length()
    };
    let full = moved(0.0);
    assert!(full > 0.1 && moved(1.0) == 0.0);
    assert!((moved(0.5) - full * 0.5).abs() < 1e-9);
}

#[test]
fn root_motion_runs_back_too() {
    let set = walk();
    let mut animator = Animator::new(vec![from(0, 0.4)]);
    let mut sum = DAffine3::IDENTITY;
    for rate in [1.0, -1.0] {
        animator.set_rate(rate).unwrap();
        for _ in 0..300 {
            sum *= matrix(&advance(&mut animator, &set, 0.01));
        }
    }
    assert!(sum.translation.length() < 1e-4, "{sum}");
    assert!(sum.matrix3.x_axis.z.abs() < 1e-5, "{sum}");
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let (mut set, skeleton) = (set(), skeleton());
    let mut animator = Animator::new(vec![Layer::new(ClipId(0))]);
    let before = animator.clone();
    let mut events = Vec::new();
    for dt in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(animator.advance(&set, dt, &mut events).is_err(), "{dt}");
    }
    for fade in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(animator.play(&set, 0, ClipId(1), fade).is_err(), "{fade}");
    }
    let no_layer = AnimationError::NoLayer {
        found: 1,
        layers: 1,
    };
    assert_eq!(animator.play(&set, 1, ClipId(1), 0.1), Err(no_layer));
    let no_clip = AnimationError::NoClip {
        found: ClipId(7),
        clips: 3,
    };
    assert_eq!(animator.play(&set, 0, ClipId(7), 0.1), Err(no_clip.clone()));
    let masked = animator.change(&set, 0.1, |layers| layers[0].mask = Some(MaskId(0)));
    assert_eq!(masked, Err(AnimationError::NoMask { found: 0, masks: 0 }));
    assert_eq!(animator, before);
    assert!(events.is_empty());

    let change: [fn(&mut Layer); 4] = [
        |layer| layer.weight = 1.5,
        |layer| layer.weight = f64::NAN,
        |layer| layer.time = f64::INFINITY,
        |layer| layer.speed = f64::NAN,
    ];
    for change in change {
        let mut broken = before.clone();
        change(&mut broken.layers_mut()[0]);
        assert!(broken.advance(&set, 0.1, &mut events).is_err());
        let mut pose = Pose::default();
        let posed = broken.pose_into(&set, &mut pose, &mut PoseBuffers::default());
        assert!(posed.is_err());
    }
    let small = Skeleton::new(vec![joint(None, Vec3::ZERO)]).unwrap();
    let foreign = JointMask::none(&small);
    let count = AnimationError::JointCount {
        expected: 3,
        found: 1,
    };
    assert_eq!(set.add_mask(foreign.clone()), Err(count.clone()));
    let branch = foreign.with_branch(&skeleton, JointId(0), 1.0);
    assert_eq!(branch, Err(count.clone()));
    assert!(JointMask::branch(&skeleton, JointId(3)).is_err());
    let branch = JointMask::none(&skeleton).with_branch(&skeleton, JointId(0), 1.1);
    assert!(branch.is_err());
    let moving = set.clone().with_root_motion(&small, JointId(0));
    assert_eq!(moving.err(), Some(count));
    assert!(set.clone().with_root_motion(&skeleton, JointId(3)).is_err());
    let clips = set.clips().to_vec();
    assert!(AnimationSet::new(&small, clips).is_err());
}

#[test]
fn a_steady_frame_allocates_nothing() {
    let set = set();
    let layers = vec![
        Layer::new(ClipId(0)),
        Layer {
            kind: LayerKind::Additive,
            ..Layer::new(ClipId(2))
        },
        Layer {
            weight: 0.5,
            ..Layer::new(ClipId(1))
        },
    ];
    let mut animator = Animator::new(layers);
    animator.play(&set, 0, ClipId(1), 10.0).unwrap();
    let (mut pose, mut buffers, mut events) = (
        Pose::default(),
        PoseBuffers::default(),
        Vec::with_capacity(64),
    );
    let mut frame = || {
        events.clear();
        animator.advance(&set, 1.0 / 60.0, &mut events).unwrap();
        animator.pose_into(&set, &mut pose, &mut buffers).unwrap();
    };
    frame();
    let counted = allocation_counter::measure(|| (0..100).for_each(|_| frame()));
    assert_eq!(counted.count_total, 0);
}
