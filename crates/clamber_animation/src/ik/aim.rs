use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DQuat, DVec3, Vec3};

use super::two_bone::check_pose;
use super::{IkError, frame_turn};
use crate::pose::{rotation_of, store_rotation};
use crate::space::{model_from_parent, uniform_inverse};

/// Turns a joint so that two axes of its own space point in given directions of model space: the first axis exactly,
/// the second as nearly as the first allows. For example, a palm lies on skin with its normal as the first axis and its
/// fingers as the second.
///
/// `axes` are in the joint's own space, `directions` in model space. Each may have any length but zero, and the two
/// vectors of a pair must not be parallel.
///
/// # Errors
/// [`IkError::NotFinite`] for the vectors or the pose, [`IkError::BadSetUp`] if the two vectors of a pair are parallel
/// or one is zero, [`IkError::NoJoint`], [`IkError::NotInvertible`], and [`IkError::Sheared`] if the joint's parents
/// scale unevenly. The pose is then unchanged.
pub fn aim(
    skeleton: &Skeleton,
    pose: &mut Pose,
    joint: JointId,
    axes: [DVec3; 2],
    directions: [DVec3; 2],
) -> Result<(), IkError> {
    check_pose(skeleton, pose, [joint])?;
    if !axes.iter().chain(&directions).all(|v| v.is_finite()) {
        return Err(IkError::NotFinite("a direction"));
    }
    let parent = model_from_parent(skeleton, pose, joint).matrix3;
    if !parent.is_finite() {
        return Err(IkError::NotFinite("the pose"));
    }
    let inverse = uniform_inverse(&parent, joint)?;
    let transform = &mut pose.transforms[joint.index()];
    // A mirrored joint flips its axes before its rotation applies.
    let signs = transform.scale.as_dvec3().signum();
    let from = frame(axes.map(|axis| axis * signs));
    let to = frame(directions.map(|direction| inverse * direction));
    let (Some(from), Some(to)) = (from, to) else {
        return Err(IkError::BadSetUp("two directions are parallel or zero"));
    };
    store_rotation(transform, frame_turn(from, to));
    Ok(())
}

/// Turns a joint so that the Y and Z axes of its own space have the same directions in model space as `rotation` gives
/// them. The parents may mirror or scale uniformly; if they mirror, the X axis points the opposite way.
///
/// # Errors
/// [`IkError::NotFinite`] for the rotation or the pose, [`IkError::NoJoint`], [`IkError::NotInvertible`], and
/// [`IkError::Sheared`] if the joint's parents scale unevenly. The pose is then unchanged.
pub fn orient(
    skeleton: &Skeleton,
    pose: &mut Pose,
    joint: JointId,
    rotation: DQuat,
) -> Result<(), IkError> {
    check_pose(skeleton, pose, [joint])?;
    // Under parents that only rotate, quaternions suffice.
    let mut parents = DQuat::IDENTITY;
    let mut next = skeleton.joints()[joint.index()].parent;
    let mut only_rotate = pose.transforms[joint.index()].scale == Vec3::ONE;
    while let Some(parent) = next.filter(|_| only_rotate) {
        let transform = &pose.transforms[parent.index()];
        only_rotate = transform.scale == Vec3::ONE;
        parents = rotation_of(transform) * parents;
        next = skeleton.joints()[parent.index()].parent;
    }
    if !only_rotate {
        let axes = [DVec3::Y, DVec3::Z];
        return aim(
            skeleton,
            pose,
            joint,
            axes,
            axes.map(|axis| rotation * axis),
        );
    }
    let local = (parents.conjugate() * rotation).normalize();
    if !local.is_finite() {
        return Err(IkError::NotFinite("a rotation or the pose"));
    }
    store_rotation(&mut pose.transforms[joint.index()], local);
    Ok(())
}

/// Two perpendicular unit vectors: the first along `first`, the second in the plane of both. `None` if the two are
/// parallel or one is zero.
fn frame([first, second]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let first = first.try_normalize()?;
    let second = second.try_normalize()?;
    let across = second - first * first.dot(second);
    (across.length() > 1e-6).then(|| [first, across.normalize()])
}
