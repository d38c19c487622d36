//! Transforms of joints in model space, and rotations of joints given in model space.

use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use crate::ik::IkError;
use crate::pose::{rotation_of, store_rotation};

/// The transform of a joint in model space. Composes the transforms of the joint and its ancestors.
///
/// # Panics
/// If the pose or the skeleton lacks the joint.
pub(crate) fn model_from_joint(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DAffine3 {
    from_above(skeleton, pose, joint, None)
}

/// As [`model_from_joint`], but starts from an ancestor whose transform in model space is known: `above`. Composes up
/// to the root if `above` is `None` or no ancestor of the joint.
fn from_above(
    skeleton: &Skeleton,
    pose: &Pose,
    joint: JointId,
    above: Option<(JointId, &DAffine3)>,
) -> DAffine3 {
    let known = |joint: JointId| above.filter(|(above, _)| *above == joint);
    let parent = |joint: JointId| skeleton.joints()[joint.index()].parent;
    // Composing rotations and translations costs less than composing matrices, and most joints have no scale.
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

/// The transform from a joint's own space to model space in a pose. `None` if the pose or the skeleton lacks the joint.
/// Composes only the joint and its ancestors.
pub fn joint_in_model(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> Option<DAffine3> {
    let joints = skeleton.joints().len();
    let is_there = joint.index() < joints && pose.transforms.len() == joints;
    is_there.then(|| model_from_joint(skeleton, pose, joint))
}

/// The transforms of several joints in model space, as [`joint_in_model`] gives them; `None` if the pose or the
/// skeleton lacks one of them. Each joint is composed from the joint before it in the list if that is an ancestor, so
/// the joints of a limb cost least in order from root to tip.
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

/// [`model_from_joint`] of a joint's parent; the identity for a root joint.
pub(crate) fn model_from_parent(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> DAffine3 {
    let parent = skeleton.joints()[joint.index()].parent;
    parent.map_or(DAffine3::IDENTITY, |parent| {
        model_from_joint(skeleton, pose, parent)
    })
}

/// Tolerance, as a share, within which a matrix counts as a rotation with uniform scale, perhaps mirrored: for the
/// cosine of the angles between its axes, and for the difference of their lengths.
const SIMILAR: f64 = 1e-4;

/// The scale of a matrix that only rotates, mirrors and scales uniformly.
///
/// # Errors
/// [`IkError::NotInvertible`] if it has no inverse, [`IkError::Sheared`] if it shears or scales unevenly.
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

/// True if a matrix only rotates or mirrors, so that its transpose is its inverse. The tolerance of 1e-11 is above the
/// rounding errors of composed rotations.
fn is_orthonormal(matrix: &DMat3) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let lengths = [x, y, z].map(|axis| (axis.length_squared() - 1.0).abs());
    let angles = [x.dot(y), y.dot(z), z.dot(x)].map(f64::abs);
    lengths.iter().chain(&angles).all(|off| *off < 1e-11)
}

/// The inverse of a matrix.
///
/// # Errors
/// [`IkError::NotInvertible`] if it has no finite inverse, or its determinant is only rounding errors.
pub(crate) fn invertible(matrix: &DMat3, joint: JointId) -> Result<DMat3, IkError> {
    if is_orthonormal(matrix) {
        return Ok(matrix.transpose());
    }
    let inverse = matrix.inverse();
    let size = matrix.x_axis.length() + matrix.y_axis.length() + matrix.z_axis.length();
    // No intended scale is this small: such a determinant consists of rounding errors.
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

/// Turns a joint and all of its descendants by a rotation in model space about the joint's own origin.
///
/// # Errors
/// [`IkError::Sheared`] and [`IkError::NotInvertible`] if the joint's parents shear, scale unevenly or scale by 0: the
/// turn is then no rotation in the joint's own space.
pub(crate) fn turn_in_model(
    pose: &mut Pose,
    joint: JointId,
    model_from_parent: &DAffine3,
    turn: DQuat,
) -> Result<(), IkError> {
    let parent = model_from_parent.matrix3;
    let vector = DVec3::new(turn.x, turn.y, turn.z);
    // A mirrored space reverses the sense of a rotation about the mirrored axis.
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
