//! A restored animator continues with the same bits.

use clamber_animation::{AnimationSet, Animator, Layer};

use crate::common::{advance, pose};

#[test]
fn a_restored_animator_goes_on_equally() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/colossus.glb");
    let rig = clamber_gltf::load(file).unwrap().rig;
    let set = AnimationSet::new(&rig.skeleton, rig.clips).unwrap();
    let [walk, swipe] = ["walk", "swipe"].map(|name| set.find(name).unwrap());
    let mut animator = Animator::new(vec![Layer::new(walk)]);
    advance(&mut animator, &set, 0.7);
    animator.play(&set, 0, swipe, 0.5).unwrap();
    advance(&mut animator, &set, 0.1);

    let text = serde_json::to_string(&animator).unwrap();
    let mut restored: Animator = serde_json::from_str(&text).unwrap();
    assert_eq!(restored, animator);
    for _ in 0..60 {
        let poses = [&mut animator, &mut restored].map(|animator| {
            advance(animator, &set, 1.0 / 60.0);
            pose(&set, animator)
        });
        assert_eq!(poses[0], poses[1]);
    }
}
