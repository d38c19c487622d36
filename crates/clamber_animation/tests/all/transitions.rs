//! Transitions between clips: scene B21.

use clamber_animation::glam::DVec3;
use clamber_animation::rig::{Clip, Interpolation, JointId, Keyframes, Playback, Skeleton};
use clamber_animation::{AnimationSet, Animator, Layer};
use clamber_gltf::LoadOptions;

use crate::common::{advance, channel, pose};

/// The giant scaled to a person's height. Its steps and shakes are then quicker than a person's.
fn giant() -> (Skeleton, AnimationSet) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    let options = LoadOptions::default().with_height(1.75);
    let rig = clamber_gltf::load_with(file, &options).unwrap().rig;
    let set = AnimationSet::new(&rig.skeleton, rig.clips).unwrap();
    (rig.skeleton, set)
}

/// Positions of all joints, in model space.
fn places(skeleton: &Skeleton, set: &AnimationSet, animator: &Animator) -> Vec<DVec3> {
    let palette = skeleton.palette(&pose(set, animator)).unwrap();
    let joints = (0..skeleton.joints().len() as u32).map(JointId);
    let frames = joints.map(|joint| palette.model_from_joint(joint).unwrap());
    frames.map(|frame| frame.translation).collect()
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// Velocities of all joints over the next 1/4096 s.
fn velocities(skeleton: &Skeleton, set: &AnimationSet, animator: &Animator) -> Vec<DVec3> {
    let step = 1.0 / 4096.0;
    let mut next = animator.clone();
    advance(&mut next, set, step);
    let [a, b] = [animator, &next].map(|animator| places(skeleton, set, animator));
    a.iter().zip(&b).map(|(a, b)| (*b - *a) / step).collect()
}

#[test]
fn b21_a_change_of_clip_has_no_jump_of_place_or_velocity() {
    let (skeleton, set) = giant();
    let names = ["idle", "walk", "shake", "swipe", "stomp", "stagger"];
    let clips = names.map(|name| set.find(name).unwrap());
    let (mut worst, mut fastest) = ([0f64; 3], 0f64);
    for from in clips {
        for to in clips {
            let mut animator = Animator::new(vec![Layer::new(from)]);
            // The time is between keys: clips are linear between keys, so their own velocity jumps at a key.
            animator.layers_mut()[0].time = 0.7123;
            let before = places(&skeleton, &set, &animator);
            let was = velocities(&skeleton, &set, &animator);
            animator.play(&set, 0, to, 0.3).unwrap();
            let after = places(&skeleton, &set, &animator);
            let is = velocities(&skeleton, &set, &animator);
            worst[0] = worst[0].max(farthest(&before, &after));
            worst[1] = worst[1].max(farthest(&was, &is));
            fastest = was.iter().map(|v| v.length()).fold(fastest, f64::max);
            // After the fade's time no offset is left, to the bit.
            for _ in 0..73 {
                advance(&mut animator, &set, 1.0 / 240.0);
            }
            assert!(!animator.is_fading());
            let plain = Animator::new(animator.layers().to_vec());
            assert_eq!(pose(&set, &animator), pose(&set, &plain));
            // The control: a cut, without a fade.
            let mut cut = Animator::new(vec![Layer::new(from)]);
            cut.layers_mut()[0].time = 0.7123;
            cut.play(&set, 0, to, 0.0).unwrap();
            worst[2] = worst[2].max(farthest(&before, &places(&skeleton, &set, &cut)));
        }
    }
    println!("{worst:?}, up to {fastest} m/s");
    assert!(worst[0] <= 1e-4 && worst[1] <= 1e-2, "{worst:?}");
    assert!(
        worst[2] > 0.1 && fastest > 1.0,
        "the test has nothing to smooth"
    );
}

/// Two clips that hold poses of the walk.
fn still() -> (Skeleton, AnimationSet) {
    let (skeleton, set) = giant();
    let walk = set.clip(set.find("walk").unwrap()).unwrap();
    let hold = |name: &str, time: f64| {
        let pose = walk.sample(set.rest(), time, Playback::Loop).unwrap();
        let channels = (0..).zip(&pose.transforms).map(|(joint, transform)| {
            let values = Keyframes::Rotation(vec![transform.rotation]);
            channel(joint, Interpolation::Step, &[0.0], values)
        });
        Clip::new(name, channels.collect())
    };
    let clips = vec![hold("a", 0.1), hold("b", 1.0)];
    let set = AnimationSet::new(&skeleton, clips).unwrap();
    (skeleton, set)
}

#[test]
fn b21_interruptions_do_not_build_up() {
    let (skeleton, set) = still();
    let clips = ["a", "b"].map(|name| set.find(name).unwrap());
    let ends = clips.map(|clip| places(&skeleton, &set, &Animator::new(vec![Layer::new(clip)])));
    let first = farthest(&ends[0], &ends[1]);
    assert!(first > 0.1, "the poses are the same");
    let mut animator = Animator::new(vec![Layer::new(clips[0])]);
    let mut last: Option<Vec<DVec3>> = None;
    for frame in 0..240 {
        // Back and forth every 0.05 s, five times in 0.3 s.
        if frame % 12 == 0 && frame <= 60 {
            let to = 1 - frame / 12 % 2;
            animator.play(&set, 0, clips[to], 0.3).unwrap();
        }
        let now = places(&skeleton, &set, &animator);
        for end in &ends {
            let away = farthest(&now, end);
            let told = format_args!("{away} m, {first} at first");
            assert!(away <= 1.1 * first, "{told}, in frame {frame}");
        }
        if let Some(last) = last {
            let speed = farthest(&last, &now) * 240.0;
            assert!(speed < 4.0 * first / 0.3, "{speed} m/s in frame {frame}");
        }
        last = Some(now);
        advance(&mut animator, &set, 1.0 / 240.0);
    }
    assert!(!animator.is_fading());
}

/// A game that cannot decide changes the animation in each frame. The pose must stay near the two clips, however fast
/// it moved before.
#[test]
fn changes_in_each_frame_do_not_let_the_pose_fly_away() {
    let (skeleton, set) = giant();
    let find = |name: &str| set.find(name).unwrap();
    let mut random = fastrand::Rng::with_seed(3);
    let (mut worst, mut settled) = (0f64, 0f64);
    for (from, clips) in [
        ("swipe", ["idle", "turn_left"]),
        ("shake", ["idle", "idle"]),
        ("stomp", ["idle", "walk"]),
    ] {
        let clips = clips.map(find);
        for (rate, fades, often) in [
            (60.0, [0.8; 2], 1),
            (60.0, [0.3; 2], 2),
            (30.0, [1.7; 2], 1),
            (240.0, [0.5; 2], 1),
            (60.0, [0.8; 2], 0),
            (60.0, [0.2, 1.7], 1),
            (60.0, [0.2, 1.7], 10),
            (60.0, [0.3, 2.9], 14),
            (60.0, [0.1, 1.7], 0),
        ] {
            for start in [0.35, 0.7123, 1.1] {
                let mut animator = Animator::new(vec![Layer::new(find(from))]);
                animator.layers_mut()[0].time = start;
                let (frames, mut changed) = ((8.0 * rate) as u32, 0);
                for frame in 0..frames {
                    let changes = match often {
                        0 => random.f64() < 0.5,
                        often => frame % often == 0,
                    };
                    if changes {
                        let to = clips[random.usize(0..2)];
                        animator.play(&set, 0, to, fades[changed % 2]).unwrap();
                        changed += 1;
                        // The clips stand still, so that only the changes move the pose.
                        animator.layers_mut()[0].speed = 0.0;
                    }
                    let now = places(&skeleton, &set, &animator);
                    let ends = clips.map(|clip| {
                        places(&skeleton, &set, &Animator::new(vec![Layer::new(clip)]))
                    });
                    let away = farthest(&now, &ends[0]).min(farthest(&now, &ends[1]));
                    worst = worst.max(away);
                    if frame + 1 == frames {
                        settled = settled.max(away);
                    }
                    advance(&mut animator, &set, 1.0 / rate);
                }
            }
        }
    }
    println!("at most {worst} m from both clips, {settled} m in the end");
    assert!(worst < 0.9 && settled < 0.3, "{worst} {settled}");
}

#[test]
fn a_fade_is_the_same_at_any_frame_rate() {
    let (_, set) = giant();
    let [walk, swipe] = ["walk", "swipe"].map(|name| set.find(name).unwrap());
    let at = |rate: u32| {
        let mut animator = Animator::new(vec![Layer::new(walk)]);
        animator.layers_mut()[0].time = 0.4;
        animator.play(&set, 0, swipe, 0.5).unwrap();
        for _ in 0..rate / 4 {
            advance(&mut animator, &set, 1.0 / f64::from(rate));
        }
        assert!(animator.is_fading());
        pose(&set, &animator)
    };
    let reference = at(4000);
    for rate in [4, 60, 240] {
        for (a, b) in at(rate).transforms.iter().zip(&reference.transforms) {
            let apart = (a.rotation - b.rotation).length();
            assert!(apart < 1e-5, "{rate}: {apart}");
        }
    }
}
