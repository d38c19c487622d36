//! Model space of poses, and rotations of joints in it.

use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use crate::ik::IkError;
use crate::pose::{rotation_of, store_rotation};

/// The transform of a joint in model space. Composes the joints from it to its root.
///
/// # Panics
/// If the pose or the skeleton lacks the joint.
pub(crate) fn model_from_joint(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DAffine3 {
    from_above(skeleton, pose, joint, None)
}

/// The same, from the joint to one above it whose transform in model space is known, or to its root if none is.
fn from_above(
    skeleton: &Skeleton,
    pose: &Pose,
    joint: JointId,
    above: Option<(JointId, &DAffine3)>,
) -> DAffine3 {
    let known = |joint: JointId| above.filter(|(above, _)| *above == joint);
    let parent = |joint: JointId| skeleton.joints()[joint.index()].parent;
    // Rotations and translations compose with less work than matrices; most joints have no scale.
    let (mut turn, mut place) = (DQuat::IDENTITY, DVec3::ZERO);
    let mut next = Some(joint);
    while let Some(joint) = next {
        if known(joint).is_some() {
            break;
        }
        let local = &pose.transforms[joint.index()];
        if local.scale != Vec3::ONE {
            break;
        }
        let rotation = rotation_of(local);
        place = local.translation.as_dvec3() + rotation * place;
        turn = rotation * turn;
        next = parent(joint);
    }
    let mut model = DAffine3::from_rotation_translation(turn, place);
    while let Some(joint) = next {
        if let Some((_, frame)) = known(joint) {
            return *frame * model;
        }
        model = pose.transforms[joint.index()].to_affine() * model;
        next = parent(joint);
    }
    model
}

/// The transform of a joint in model space in a pose: from the joint's own space. `None` if the pose or the skeleton
/// lacks the joint. Composes the joints from it to its root, and nothing else.
pub fn joint_in_model(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> Option<DAffine3> {
    let joints = skeleton.joints().len();
    let is_there = joint.index() < joints && pose.transforms.len() == joints;
    is_there.then(|| model_from_joint(skeleton, pose, joint))
}

/// The transforms of several joints in model space in a pose, as [`joint_in_model`] gives them; `None` if the pose or
/// the skeleton lacks one. Less work for joints of one limb, if they are given from its root to its tip: each is
/// composed from the one before it, if that is above it.
pub fn joints_in_model<const N: usize>(
    skeleton: &Skeleton,
    pose: &Pose,
    joints: [JointId; N],
) -> Option<[DAffine3; N]> {
    let count = skeleton.joints().len();
    let are_there = joints.iter().all(|joint| joint.index() < count);
    if !are_there || pose.transforms.len() != count {
        return None;
    }
    let mut frames = [DAffine3::IDENTITY; N];
    for (index, joint) in joints.into_iter().enumerate() {
        let above = index.checked_sub(1);
        let above = above.map(|above| (joints[above], &frames[above]));
        frames[index] = from_above(skeleton, pose, joint, above);
    }
    Some(frames)
}

/// [`model_from_joint`] of a joint's parent; the identity for a root.
pub(crate) fn model_from_parent(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DAffine3 {
    let parent = skeleton.joints()[joint.index()].parent;
    parent.map_or(DAffine3::IDENTITY, |parent| {
        model_from_joint(skeleton, pose, parent)
    })
}

/// How far the axes of a matrix may be from perpendicular, and their lengths from equal, as a share, for it to count as
/// a rotation with a uniform scale, perhaps mirrored.
const SIMILAR: f64 = 1e-4;

/// The scale of a matrix that only rotates, mirrors and scales uniformly.
///
/// # Errors
/// [`IkError::NotInvertible`] if it has no inverse, [`IkError::Sheared`] if it scales unevenly.
pub(crate) fn uniform_scale(matrix: &DMat3, joint: JointId) -> Result<f64, IkError> {
    if is_orthonormal(matrix) {
        return Ok(1.0);
    }
    let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let scale = axes[0].length();
    invertible(matrix, joint)?;
    let even = axes
        .iter()
        .all(|axis| (axis.length() - scale).abs() <= SIMILAR * scale);
    let [x, y, z] = axes;
    let skew = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs());
    if even && skew <= SIMILAR * scale * scale {
        Ok(scale)
    } else {
        Err(IkError::Sheared(joint))
    }
}

/// True if a matrix only rotates, or mirrors, so that its transpose is its inverse: to 1e-11, more than what composing
/// rotations rounds away.
fn is_orthonormal(matrix: &DMat3) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let lengths = [x, y, z].map(|axis| (axis.length_squared() - 1.0).abs());
    let angles = [x.dot(y), y.dot(z), z.dot(x)].map(f64::abs);
    lengths.iter().chain(&angles).all(|off| *off < 1e-11)
}

/// The inverse of a matrix.
///
/// # Errors
/// [`IkError::NotInvertible`] if it has none that is finite.
pub(crate) fn invertible(matrix: &DMat3, joint: JointId) -> Result<DMat3, IkError> {
    if is_orthonormal(matrix) {
        return Ok(matrix.transpose());
    }
    let inverse = matrix.inverse();
    let size = matrix.x_axis.length() + matrix.y_axis.length() + matrix.z_axis.length();
    // Smaller than any scale that is meant: a determinant of rounding errors.
    let least = size * size * size * 1e-12;
    if inverse.is_finite() && matrix.determinant().abs() > least {
        Ok(inverse)
    } else {
        Err(IkError::NotInvertible(joint))
    }
}

/// The inverse of a matrix that only rotates, mirrors and scales uniformly.
///
/// # Errors
/// As [`uniform_scale`].
pub(crate) fn uniform_inverse(matrix: &DMat3, joint: JointId) -> Result<DMat3, IkError> {
    if is_orthonormal(matrix) {
        return Ok(matrix.transpose());
    }
    uniform_scale(matrix, joint)?;
    invertible(matrix, joint)
}

/// Turns a joint, and all below it, by a rotation in model space about the joint's own origin.
///
/// # Errors
/// [`IkError::Sheared`] and [`IkError::NotInvertible`] if its parents scale unevenly, so that the turn is no rotation
/// in the joint's own space.
pub(crate) fn turn_in_model(
    pose: &mut Pose,
    joint: JointId,
    model_from_parent: &DAffine3,
    turn: DQuat,
) -> Result<(), IkError> {
    let parent = model_from_parent.matrix3;
    let vector = DVec3::new(turn.x, turn.y, turn.z);
    // In a mirrored space a turn goes the other way about its mirrored axis.
    let axis = if is_orthonormal(&parent) {
        parent.transpose() * vector * parent.determinant().signum()
    } else {
        let axis = uniform_inverse(&parent, joint)? * vector;
        axis.normalize_or_zero() * vector.length() * parent.determinant().signum()
    };
    let local = DQuat::from_xyzw(axis.x, axis.y, axis.z, turn.w);
    let transform = &mut pose.transforms[joint.index()];
    store_rotation(transform, local * rotation_of(transform));
    Ok(())
}
