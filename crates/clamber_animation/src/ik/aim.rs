use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::DVec3;

use super::two_bone::check_pose;
use super::{IkError, frame_turn};
use crate::pose::store_rotation;
use crate::space::{invertible, model_from_parent, uniform_scale};

/// Turns a joint so that two axes of its own space point where they should in model space: the first exactly, the second
/// as nearly as the first allows. A palm, for example, lies on skin with its normal first and its fingers second.
///
/// `axes` are in the joint's own space, `directions` in model space; each may have any length but zero, and the two of a
/// pair must not be parallel.
///
/// # Errors
/// [`IkError::NotFinite`] for the vectors or the pose, [`IkError::BadSetUp`] if two of a pair are parallel,
/// [`IkError::NoJoint`], [`IkError::NotInvertible`], and [`IkError::Sheared`] if the joint's parents scale unevenly. The
/// pose is unchanged then.
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
    uniform_scale(&parent, joint)?;
    let inverse = invertible(&parent, joint)?;
    let transform = &mut pose.transforms[joint.index()];
    // A mirrored joint's axes point the other way before it is turned.
    let signs = transform.scale.as_dvec3().signum();
    let from = frame(axes.map(|axis| axis * signs));
    let to = frame(directions.map(|direction| inverse * direction));
    let (Some(from), Some(to)) = (from, to) else {
        return Err(IkError::BadSetUp("two directions are parallel or zero"));
    };
    store_rotation(transform, frame_turn(from, to));
    Ok(())
}

/// Two unit vectors across each other, the first along the first.
fn frame([first, second]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let first = first.try_normalize()?;
    let second = second.try_normalize()?;
    let across = second - first * first.dot(second);
    (across.length() > 1e-6).then(|| [first, across.normalize()])
}
