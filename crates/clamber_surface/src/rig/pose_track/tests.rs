use super::*;
use crate::geometry::rotation_from_axis_angle;
use crate::rig::{Transform, rotation_f32};
use glam::{DQuat, DVec3, Quat, Vec3};

/// A joint at `x`, turned by `angle`.
fn pose(x: f64, angle: f64) -> Pose {
    Pose {
        transforms: vec![Transform {
            translation: Vec3::X * x as f32,
            rotation: rotation_f32(rotation_from_axis_angle(DVec3::Z, angle)),
            scale: Vec3::ONE,
        }],
    }
}

/// Records the pose of an unturned joint at `x`.
fn record(track: &mut PoseTrack, time: f64, x: f64, place: Similarity) {
    track.record(time, &pose(x, 0.0), place).unwrap();
}

/// Where the joint is in the world.
fn place(track: &PoseTrack) -> DVec3 {
    let joint = track.pose().transforms[0].translation;
    track.world_from_model().transform_point_f32(joint)
}

/// Ticks at which poses of their own time come.
enum Rhythm {
    /// In every n-th tick, as late as some ticks.
    Every(u32, u32),
    /// At this rate, Hz, in the next tick.
    At(f64),
}

impl Rhythm {
    /// The times of the poses that come in a tick.
    fn times(&self, tick: u32, rate: f64) -> Vec<f64> {
        match *self {
            Self::Every(every, late) => match tick.checked_sub(late) {
                Some(of) if of.is_multiple_of(every) => vec![f64::from(of) / rate],
                _ => Vec::new(),
            },
            Self::At(poses) => {
                let until = (f64::from(tick) * poses / rate + 1e-9).floor();
                let before = ((f64::from(tick) - 1.0) * poses / rate + 1e-9).floor();
                let count = (until - before) as u32;
                (0..count)
                    .map(|k| (before + 1.0 + f64::from(k)) / poses)
                    .collect()
            }
        }
    }
}

/// The largest difference of the joint's velocity from the true one after the first half second, as a share, and the
/// number of ticks in which it was placed then.
fn error(rhythm: &Rhythm, rate: f64, size: f64, frame: f64) -> (f64, u32) {
    let speed = 2.0 * size;
    let true_velocity = DVec3::new(speed, 0.0, frame);
    let (mut track, mut before) = (PoseTrack::default(), DVec3::ZERO);
    let (mut worst, mut placed) = (0.0f64, 0);
    for tick in 0..(2.0 * rate) as u32 {
        for time in rhythm.times(tick, rate) {
            let world = Similarity::from_translation(DVec3::Z * (frame * time));
            track
                .record(time, &pose(speed * time, 0.3 * time), world)
                .unwrap();
        }
        let now = f64::from(tick) / rate;
        let motion = match track.tick(now, 1.0 / rate) {
            Ok(motion) => motion,
            Err(RigError::NoPose) => continue,
            Err(error) => panic!("{error}"),
        };
        let velocity = (place(&track) - before) * rate;
        before = place(&track);
        if now > 0.5 {
            match motion {
                PoseMotion::Moved => worst = worst.max((velocity - true_velocity).length()),
                PoseMotion::Teleported => placed += 1,
            }
        }
    }
    (worst / true_velocity.length(), placed)
}

#[test]
fn steady_motion_stays_steady_however_seldom_poses_come() {
    for rate in [30.0, 60.0, 120.0, 240.0] {
        for size in [0.02, 1.0, 100.0] {
            for frame in [0.0, 30.0, 300.0] {
                for every in [1, 2, 3, 4, 6] {
                    for late in [0, 1, 3] {
                        let found = error(&Rhythm::Every(every, late), rate, size, frame);
                        let case = format!("{rate} Hz, {size}, {frame} m/s, {every}, {late}");
                        // The limit of f32: 1e-7 of the joint's position, in a tick.
                        assert!(found.0 < 1e-4 && found.1 == 0, "{case}: {found:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn poses_of_another_rhythm_than_ticks_move_evenly() {
    for rate in [30.0, 60.0, 64.0, 144.0] {
        for poses in [24.0, 25.0, 17.3, 10.0, 50.0, 90.0] {
            for frame in [0.0, 300.0] {
                let found = error(&Rhythm::At(poses), rate, 1.0, frame);
                // The lag may change by 1/200.
                let case = format!("{poses} Hz at {rate} Hz, {frame} m/s");
                assert!(found.0 < 0.006 && found.1 == 0, "{case}: {found:?}");
            }
        }
    }
}

#[test]
fn a_missed_pose_places_and_does_not_move_faster() {
    /// Tick rate, Hz.
    const RATE: f64 = 60.0;
    for missed in 1..4 {
        let mut track = PoseTrack::default();
        let (mut before, mut placed) = (0.0, 0);
        for tick in 0..300u32 {
            let now = f64::from(tick) / RATE;
            let is_missed = (100..100 + 3 * missed).contains(&tick);
            if tick.is_multiple_of(3) && !is_missed {
                record(&mut track, now, now, Similarity::IDENTITY);
            }
            let motion = track.tick(now, 1.0 / RATE).unwrap();
            let moved = (place(&track).x - before) * RATE;
            before = place(&track).x;
            assert!(moved >= 0.0, "tick {tick}: {moved}");
            if motion == PoseMotion::Moved {
                assert!((moved - 1.0).abs() < 0.006, "tick {tick}: {moved}");
            } else if tick > 10 {
                placed += 1;
            }
        }
        // The ticks without a pose, and the tick in which poses come again.
        assert!(
            (3 * missed..3 * missed + 2).contains(&placed),
            "{missed}: {placed}"
        );
    }
}

#[test]
fn a_restart_shows_the_new_pose_at_once_and_is_no_motion() {
    let mut track = PoseTrack::default();
    for (time, far) in [(0.0, 0.0), (0.05, 0.1), (0.1, 0.2)] {
        record(&mut track, time, far, Similarity::IDENTITY);
        for late in 0..3 {
            let now = time + f64::from(late) / 60.0;
            track.tick(now, 1.0 / 60.0).unwrap();
        }
    }
    let there = Similarity::from_translation(DVec3::X * 500.0);
    for start in [0.15, 0.0, -7.0] {
        track.restart(start, &pose(0.3, 0.0), there).unwrap();
        let mut begun = 0;
        for tick in 0..20u32 {
            let now = start + f64::from(tick) / 60.0;
            if tick > 0 && tick.is_multiple_of(3) {
                record(&mut track, now, 0.3 + now - start, there);
            }
            let before = place(&track).x;
            let motion = track.tick(now, 1.0 / 60.0).unwrap();
            let moved = place(&track).x - before;
            if motion == PoseMotion::Moved {
                assert!(
                    (moved * 60.0 - 1.0).abs() < 0.01,
                    "{start}, {tick}: {moved}"
                );
                begun += 1;
            } else {
                assert!(
                    (place(&track).x - 500.3).abs() < 1e-6,
                    "{start}, {tick}: {moved}"
                );
            }
        }
        assert_eq!(begun, 16, "from {start}");
    }
}

#[test]
fn rotations_and_places_take_the_shorter_arc_between_poses() {
    let turned = |angle| Similarity {
        rotation: -rotation_from_axis_angle(DVec3::Y, angle),
        scale: 2.0 + angle,
        translation: DVec3::X * (1e7 + angle),
    };
    let mut track = PoseTrack::default();
    track.record(0.0, &pose(0.0, 0.0), turned(0.0)).unwrap();
    track.tick(0.0, 0.1).unwrap();
    track.record(0.2, &pose(1.0, 3.0), turned(0.4)).unwrap();
    track.tick(0.2, 0.1).unwrap();
    assert_eq!(track.tick(0.3, 0.1), Ok(PoseMotion::Moved));
    assert!((track.clock().time() - 0.1).abs() < 1e-15);
    let half = pose(0.5, 1.5).transforms[0];
    let found = track.pose().transforms[0];
    assert!((found.translation - half.translation).length() < 1e-6);
    let is_same = |a: DQuat, b: DQuat| a.dot(b).abs() > 1.0 - 1e-12;
    assert!(is_same(found.rotation.as_dquat(), half.rotation.as_dquat()));
    let (found, half) = (track.world_from_model(), turned(0.2));
    assert!(is_same(found.rotation, half.rotation));
    assert!((found.scale - 2.2).abs() < 1e-12);
    assert!(found.translation.distance(half.translation) < 1e-8);
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let mut track = PoseTrack::default();
    assert_eq!(track.tick(0.0, 0.1), Err(RigError::NoPose));
    assert_eq!(track, PoseTrack::default());
    let there = Similarity::IDENTITY;
    for time in [0.0, 0.3, 0.6] {
        track.record(time, &pose(time, time), there).unwrap();
        track.tick(time, 0.1).unwrap();
    }
    let before = track.clone();
    let mut broken = pose(1.0, 0.0);
    broken.transforms[0].rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let mut two = pose(1.0, 0.0);
    two.transforms.push(Transform::IDENTITY);
    let flat = Similarity::from_scale(0.0);
    let good = pose(1.0, 0.0);
    for time in [f64::NAN, f64::INFINITY] {
        let not_finite = |found| matches!(found, Err(RigError::NotFinite { .. }));
        assert!(not_finite(track.record(time, &good, there)), "{time}");
        assert!(not_finite(track.restart(time, &good, there)), "{time}");
        assert!(not_finite(track.tick(time, 0.1).map(|_| ())), "{time}");
        assert!(not_finite(track.tick(0.9, time).map(|_| ())), "{time}");
    }
    assert!(matches!(
        track.record(0.9, &two, there),
        Err(RigError::JointCount {
            expected: 1,
            found: 2
        })
    ));
    let placed = Err(RigError::WorldFromModel);
    assert_eq!(track.record(0.9, &good, flat), placed);
    assert_eq!(track.restart(0.9, &good, flat), placed);
    assert!(track.record(0.9, &broken, there).is_err());
    assert!(track.restart(0.9, &broken, there).is_err());
    let back = |what| RigError::TimeGoesBack {
        what,
        time: 0.5,
        last: 0.6,
    };
    let recorded = track.record(0.5, &good, there);
    assert_eq!(recorded, Err(back("the pose's time")));
    assert_eq!(track.tick(0.5, 0.1), Err(back("the tick's time")));
    assert!(matches!(
        track.tick(0.7, -0.1),
        Err(RigError::TimeGoesBack { .. })
    ));
    assert_eq!(track, before);
    // The rejected calls have no effect on later ticks, either.
    let mut same = before;
    for track in [&mut track, &mut same] {
        track.record(0.9, &good, there).unwrap();
        track.tick(0.9, 0.1).unwrap();
    }
    assert_eq!(track, same);
}

#[test]
fn a_pose_of_the_same_time_replaces_the_last() {
    let mut track = PoseTrack::default();
    for x in [1.0, 2.0] {
        record(&mut track, 0.0, x, Similarity::IDENTITY);
    }
    track.tick(0.0, 0.1).unwrap();
    assert_eq!(place(&track).x, 2.0);
}
