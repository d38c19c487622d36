//! Helpers for the tests of joints and animators.

use clamber_animation::glam::{DAffine3, DQuat, DVec3, Vec3};
use clamber_animation::rig::{
    Channel, Interpolation, Joint, JointId, Keyframes, Pose, Skeleton, Transform,
};
use clamber_animation::{AnimationSet, Animator, PoseBuffers, RootDelta};
use clamber_surface::geometry::Affine;

pub(crate) fn joint(parent: Option<u32>, translation: Vec3) -> Joint {
    Joint {
        name: String::new(),
        parent: parent.map(JointId),
        rest: Transform::from_translation(translation),
        inverse_bind: Affine::IDENTITY,
    }
}

/// The frame of a joint in model space.
pub(crate) fn frame(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DAffine3 {
    let palette = skeleton.palette(pose).unwrap();
    *palette.model_from_joint(joint).unwrap()
}

/// Position of a joint in model space.
pub(crate) fn place(skeleton: &Skeleton, pose: &Pose, joint: u32) -> DVec3 {
    frame(skeleton, pose, JointId(joint)).translation
}

/// The angle between two directions.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

pub(crate) fn channel(
    joint: u32,
    interpolation: Interpolation,
    times: &[f32],
    values: Keyframes,
) -> Channel {
    Channel::new(JointId(joint), interpolation, times.to_vec(), values).unwrap()
}

pub(crate) fn pose(set: &AnimationSet, animator: &Animator) -> Pose {
    let mut pose = Pose::default();
    let posed = animator.pose_into(set, &mut pose, &mut PoseBuffers::default());
    posed.unwrap();
    pose
}

/// Advances an animator; drops its events.
pub(crate) fn advance(animator: &mut Animator, set: &AnimationSet, dt: f64) -> RootDelta {
    animator.advance(set, dt, &mut Vec::new()).unwrap()
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
