//! Clips of a timetable are repeated without jumps.

use clamber::animation::{Seam, SeamProbe};
use clamber::glam::Vec3;
use clamber::rig::{Channel, Clip, Interpolation, JointId, Keyframes};
use clamber_scenes::battle::{Repeat, TICK};
use clamber_scenes::giant::giant_of;

/// The longest step of a clip's time in one tick, over a minute.
fn longest_step(repeat: Repeat, duration: f64) -> f64 {
    let at = |tick: u32| repeat.time(f64::from(tick) * TICK, duration);
    let steps = (0..3600).map(|tick| (at(tick + 1) - at(tick)).abs());
    steps.fold(0.0, f64::max)
}

#[test]
fn back_and_forth_covers_the_clip_and_never_jumps() {
    for duration in [0.05, 0.25, 0.62, 3.0] {
        let times: Vec<f64> = (0..36_000)
            .map(|n| Repeat::BackAndForth.time(f64::from(n) * 0.001, duration))
            .collect();
        let (low, high) = times
            .iter()
            .fold((f64::INFINITY, 0.0f64), |(low, high), t| {
                (low.min(*t), high.max(*t))
            });
        assert!((0.0..1e-4).contains(&low), "{duration}: begins at {low}");
        assert!(
            (duration - 1e-4..=duration).contains(&high),
            "{duration}: ends at {high}"
        );
        // Never faster than forwards, and without sudden changes of speed.
        let speeds: Vec<f64> = times.windows(2).map(|w| (w[1] - w[0]) / 0.001).collect();
        let fastest = speeds.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        assert!(fastest < 1.0 + 1e-9, "{duration}: {fastest} of its speed");
        let jerk = speeds.windows(2).map(|w| (w[1] - w[0]).abs());
        let jerk = jerk.fold(0.0, f64::max);
        assert!(jerk < 0.021, "{duration}: speed changes by {jerk} in 1 ms");
    }
}

#[test]
fn clips_of_a_creature_are_measured() {
    let creature = giant_of(1_000).unwrap();
    let (low, high) = creature.bounds(&creature.rig.skeleton.rest_pose()).unwrap();
    let height = f64::from(high.y - low.y);
    let probe = SeamProbe::new(&creature.rig.skeleton, &creature.rig.collider, height);
    let loops = |clip: &&Clip| ["idle", "walk", "shake"].contains(&clip.name.as_str());
    let clips: Vec<_> = creature.rig.clips.iter().filter(loops).collect();
    assert_eq!(clips.len(), 3);
    for clip in clips {
        let seam = probe.measure(clip).unwrap();
        assert_eq!(Repeat::of(seam), Repeat::Loop, "{}: {seam:?}", clip.name);
    }
    // The root moves by the creature's height in a second, and jumps back.
    let way = Vec3::new(height as f32, 0.0, 0.0);
    let mut joints = creature.rig.skeleton.joints().iter();
    let root = joints.position(|joint| joint.parent.is_none()).unwrap();
    let rest = creature.rig.skeleton.joints()[root].rest.translation;
    let there = Keyframes::Translation(vec![rest, rest + way]);
    let linear = Interpolation::Linear;
    let joint = JointId(root as u32);
    let channel = Channel::new(joint, linear, vec![0.0, 1.0], there).unwrap();
    let seam = probe.measure(&Clip::new("leap", vec![channel])).unwrap();
    assert!((seam.within - 1.0).abs() < 1e-3, "{seam:?}");
    assert!((58.0..60.0).contains(&seam.speed), "{seam:?}");
    assert_eq!(Repeat::of(seam), Repeat::BackAndForth);
}

#[test]
fn only_a_loop_jumps_at_its_end() {
    assert!(longest_step(Repeat::Loop, 1.3) > 1.2);
    assert!(longest_step(Repeat::BackAndForth, 1.3) <= TICK + 1e-9);
}

#[test]
fn a_seam_is_judged_by_the_clip_around_it() {
    let seam = |speed, within| Repeat::of(Seam { speed, within });
    assert_eq!(seam(12.0, 1.0), Repeat::BackAndForth);
    assert_eq!(seam(1.0, 1.0), Repeat::Loop);
    // A fast clip may be fast at its seam; a still one may creep.
    assert_eq!(seam(12.0, 11.0), Repeat::Loop);
    assert_eq!(seam(0.005, 0.0), Repeat::Loop);
}
