//! Helpers for the tests of joints.

use clamber_animation::glam::{DQuat, DVec3, Vec3};
use clamber_animation::rig::{Joint, JointId, Pose, Skeleton, Transform};
use clamber_surface::geometry::Affine;

pub(crate) fn joint(parent: Option<u32>, translation: Vec3) -> Joint {
    Joint {
        name: String::new(),
        parent: parent.map(JointId),
        rest: Transform::from_translation(translation),
        inverse_bind: Affine::IDENTITY,
    }
}

/// Position of a joint in model space.
pub(crate) fn place(skeleton: &Skeleton, pose: &Pose, joint: u32) -> DVec3 {
    let palette = skeleton.palette(pose).unwrap();
    palette
        .model_from_joint(JointId(joint))
        .unwrap()
        .translation
}

pub(crate) fn random(rng: &mut fastrand::Rng, size: f64) -> DVec3 {
    DVec3::from([(); 3].map(|()| (rng.f64() * 2.0 - 1.0) * size))
}

pub(crate) fn unit(rng: &mut fastrand::Rng) -> DVec3 {
    loop {
        let v = random(rng, 1.0);
        if (0.01..=1.0).contains(&v.length()) {
            return v.normalize();
        }
    }
}

pub(crate) fn rotation(rng: &mut fastrand::Rng) -> DQuat {
    let [x, y, z, w] = [(); 4].map(|()| rng.f64() * 2.0 - 1.0);
    let q = DQuat::from_xyzw(x, y, z, w);
    if q.length() < 0.1 {
        DQuat::IDENTITY
    } else {
        q.normalize()
    }
}
