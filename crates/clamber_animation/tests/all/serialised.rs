//! A restored animator continues with the same bits.

use clamber_animation::rig::Pose;
use clamber_animation::{AnimationSet, Animator, Layer, PoseBuffers};

#[test]
fn a_restored_animator_goes_on_equally() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    let rig = clamber_gltf::load(file).unwrap().rig;
    let set = AnimationSet::new(&rig.skeleton, rig.clips).unwrap();
    let [walk, swipe] = ["walk", "swipe"].map(|name| set.find(name).unwrap());
    let mut animator = Animator::new(vec![Layer::new(walk)]);
    animator.advance(&set, 0.7, &mut Vec::new()).unwrap();
    animator.play(&set, 0, swipe, 0.5).unwrap();
    animator.advance(&set, 0.1, &mut Vec::new()).unwrap();

    let text = serde_json::to_string(&animator).unwrap();
    let mut restored: Animator = serde_json::from_str(&text).unwrap();
    assert_eq!(restored, animator);
    for _ in 0..60 {
        let poses = [&mut animator, &mut restored].map(|animator| {
            animator.advance(&set, 1.0 / 60.0, &mut Vec::new()).unwrap();
            let mut pose = Pose::default();
            animator
                .pose_into(&set, &mut pose, &mut PoseBuffers::default())
                .unwrap();
            pose
        });
        assert_eq!(poses[0], poses[1]);
    }
}
