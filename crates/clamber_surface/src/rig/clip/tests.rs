use super::*;
use crate::geometry::{rotation_from_axis_angle, rotation_vector};
use crate::rig::Transform;

fn rest(joints: usize) -> Pose {
    Pose {
        transforms: vec![Transform::IDENTITY; joints],
    }
}

fn xs(values: &[f32]) -> Keyframes {
    Keyframes::Translation(values.iter().map(|x| Vec3::new(*x, 0.0, 0.0)).collect())
}

fn clip(interpolation: Interpolation, times: &[f32], values: Keyframes) -> Clip {
    let channel = Channel::new(JointId(0), interpolation, times.to_vec(), values).unwrap();
    Clip::new("test", vec![channel])
}

fn x_at(clip: &Clip, time: f64, playback: Playback) -> f32 {
    let pose = clip.sample(&rest(1), time, playback).unwrap();
    pose.transforms[0].translation.x
}

#[test]
fn step_and_linear_with_a_late_start() {
    let times = [2.0, 3.0, 5.0];
    let step = clip(Interpolation::Step, &times, xs(&[10.0, 20.0, 40.0]));
    let linear = clip(Interpolation::Linear, &times, xs(&[10.0, 20.0, 40.0]));
    assert_eq!(step.duration(), 3.0);
    for (time, stepped, lined) in [
        (-1.0, 10.0, 10.0),
        (0.0, 10.0, 10.0),
        (0.5, 10.0, 15.0),
        (1.0, 20.0, 20.0),
        (2.0, 20.0, 30.0),
        (3.0, 40.0, 40.0),
        (9.0, 40.0, 40.0),
    ] {
        assert_eq!(
            x_at(&step, time, Playback::Clamp),
            stepped,
            "step at {time}"
        );
        assert_eq!(
            x_at(&linear, time, Playback::Clamp),
            lined,
            "linear at {time}"
        );
    }
    assert_eq!(x_at(&linear, 3.5, Playback::Loop), 15.0);
    assert_eq!(x_at(&linear, -2.5, Playback::Loop), 15.0);
}

#[test]
fn a_clip_without_length_holds_its_key_frame() {
    for playback in [Playback::Loop, Playback::Clamp] {
        let single = clip(Interpolation::Linear, &[1.5], xs(&[7.0]));
        assert_eq!(single.duration(), 0.0);
        assert_eq!(x_at(&single, 123.4, playback), 7.0);
        let twice = clip(Interpolation::Linear, &[1.5, 1.5], xs(&[7.0, 8.0]));
        assert_eq!(x_at(&twice, 0.0, playback), 8.0);
        assert_eq!(x_at(&Clip::new("", vec![]), 3.0, playback), 0.0);
    }
}

#[test]
fn cubic_spline_reproduces_a_cubic() {
    // x = t^3 - t on [0, 2]: value and slope at the ends determine it.
    let values = xs(&[-1.0, 0.0, -1.0, 11.0, 6.0, 11.0]);
    let clip = clip(Interpolation::CubicSpline, &[0.0, 2.0], values);
    for k in 0..=20 {
        let t = f64::from(k) / 10.0;
        let expected = t * t * t - t;
        let found = f64::from(x_at(&clip, t, Playback::Clamp));
        assert!((found - expected).abs() < 1e-6, "{t}: {found} {expected}");
    }
}

#[test]
fn rotations_take_the_shorter_arc() {
    let a = rotation_f32(rotation_from_axis_angle(DVec3::Y, 0.3));
    let b = rotation_f32(rotation_from_axis_angle(DVec3::Y, 1.1));
    let flipped = Quat::from_xyzw(-b.x, -b.y, -b.z, -b.w);
    for end in [b, flipped] {
        let clip = clip(
            Interpolation::Linear,
            &[0.0, 1.0],
            Keyframes::Rotation(vec![a, end]),
        );
        let pose = clip.sample(&rest(1), 0.25, Playback::Clamp).unwrap();
        let turned = rotation_vector(rotation_f64(pose.transforms[0].rotation));
        assert!((turned - DVec3::Y * 0.5).length() < 1e-6, "{turned}");
    }
}

#[test]
fn cubic_rotation_survives_cancelling_values() {
    let q = Quat::IDENTITY;
    let minus = Quat::from_xyzw(0.0, 0.0, 0.0, -1.0);
    let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let clip = clip(
        Interpolation::CubicSpline,
        &[0.0, 1.0],
        Keyframes::Rotation(vec![zero, q, zero, zero, minus, zero]),
    );
    let pose = clip.sample(&rest(1), 0.5, Playback::Clamp).unwrap();
    assert!(pose.transforms[0].is_valid());
}

#[test]
fn bad_channels_are_refused() {
    let new = |interpolation, times: &[f32], values| {
        Channel::new(JointId(0), interpolation, times.to_vec(), values)
    };
    assert!(matches!(
        new(Interpolation::Linear, &[], xs(&[])),
        Err(RigError::KeyframeCount { .. })
    ));
    assert!(matches!(
        new(Interpolation::CubicSpline, &[0.0], xs(&[1.0])),
        Err(RigError::KeyframeCount { expected: 3, .. })
    ));
    assert!(matches!(
        new(Interpolation::Step, &[1.0, 0.5], xs(&[1.0, 2.0])),
        Err(RigError::TimesNotSorted { index: 1 })
    ));
    assert!(matches!(
        new(Interpolation::Step, &[f32::NAN], xs(&[1.0])),
        Err(RigError::NotFinite { .. })
    ));
    let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert!(new(Interpolation::Step, &[0.0], Keyframes::Rotation(vec![zero])).is_err());
}

#[test]
fn bad_samples_leave_the_pose_alone() {
    let channel =
        |joint| Channel::new(JointId(joint), Interpolation::Step, vec![0.0], xs(&[9.0])).unwrap();
    let clip = Clip::new("two", vec![channel(0), channel(5)]);
    let mut pose = rest(2);
    assert!(matches!(
        clip.sample_into(0.0, Playback::Loop, &mut pose),
        Err(RigError::JointOutOfRange { .. })
    ));
    assert!(
        clip.sample_into(f64::NAN, Playback::Loop, &mut pose)
            .is_err()
    );
    assert_eq!(pose, rest(2));
}
