use super::*;

/// A history of poses that are numbers: 0 from 0 s to 1 s, then 2 at 2 s, and 5 at 5 s.
fn history(motion: PoseMotion) -> PoseHistory<f64> {
    let mut history = PoseHistory::new();
    history.record(0.0, 0.0, PoseMotion::Moved).unwrap();
    history.stay(1.0, 0.0).unwrap();
    history.record(2.0, 2.0, motion).unwrap();
    history.record(5.0, 5.0, PoseMotion::Moved).unwrap();
    history
}

/// The pose at a time, and how the creature got there.
fn seen(history: &mut PoseHistory<f64>, time: f64) -> (f64, PoseMotion) {
    let at = history.advance(time);
    let pose = match history.poses(at).unwrap() {
        (from, None) => *from,
        (from, Some(to)) => from + (to - from) * at.fraction,
    };
    (pose, at.motion)
}

#[test]
fn a_pose_stays_until_its_last_time_and_then_moves_to_the_next() {
    let mut history = history(PoseMotion::Moved);
    for (time, pose) in [
        (-1.0, 0.0),
        (0.0, 0.0),
        (0.7, 0.0),
        (1.0, 0.0),
        (1.25, 0.5),
        (2.0, 2.0),
        (3.5, 3.5),
        (5.0, 5.0),
        (9.0, 5.0),
    ] {
        let found = seen(&mut history, time);
        assert_eq!(found, (pose, PoseMotion::Moved), "at {time} s");
    }
    assert_eq!((history.len(), history.last()), (1, Some((&5.0, 5.0))));
}

#[test]
fn after_the_last_pose_before_a_teleport_the_creature_is_at_its_end() {
    let mut history = history(PoseMotion::Teleported);
    assert_eq!(seen(&mut history, 1.0), (0.0, PoseMotion::Moved));
    for time in [1.1, 1.9, 2.0] {
        let found = seen(&mut history, time);
        assert_eq!(found, (2.0, PoseMotion::Teleported), "at {time} s");
    }
    assert_eq!(seen(&mut history, 3.5), (3.5, PoseMotion::Moved));
}

#[test]
fn a_teleport_that_is_passed_between_two_ticks_is_none_of_motion() {
    let mut history = history(PoseMotion::Teleported);
    assert_eq!(seen(&mut history, 0.5), (0.0, PoseMotion::Moved));
    assert_eq!(seen(&mut history, 3.5), (3.5, PoseMotion::Teleported));
}

#[test]
fn poses_that_nobody_asks_for_are_limited() {
    let mut history = PoseHistory::new();
    for time in 0..1000u32 {
        let time = f64::from(time);
        history.record(time, time, PoseMotion::Moved).unwrap();
    }
    assert_eq!(history.len(), MOST);
    assert_eq!(seen(&mut history, 998.5), (998.5, PoseMotion::Moved));
}

#[test]
fn bad_times_change_nothing() {
    let mut history = history(PoseMotion::Moved);
    let before = history.clone();
    for time in [f64::NAN, f64::INFINITY] {
        let not_finite = |found| matches!(found, Err(RigError::NotFinite { .. }));
        assert!(not_finite(history.record(time, 7.0, PoseMotion::Moved)));
        assert!(not_finite(history.stay(time, 7.0)));
        assert!(not_finite(history.restart(time, 7.0)));
    }
    let back = RigError::TimeGoesBack {
        what: "the pose's time",
        time: 4.0,
        last: 5.0,
    };
    assert_eq!(history.stay(4.0, 7.0), Err(back.clone()));
    assert_eq!(history.record(4.0, 7.0, PoseMotion::Moved), Err(back));
    assert_eq!(history, before);
    history.restart(4.0, 7.0).unwrap();
    assert_eq!((history.len(), history.last()), (1, Some((&7.0, 4.0))));
}
