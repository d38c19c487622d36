//! Bends a posed body to its weapons.

use clamber_body::clamber_animation::ik::{IkError, TwoBoneGoal, orient};
use clamber_body::clamber_animation::joint_in_model;
use clamber_body::{Figure, Side};
use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::Grip;

/// How far the trunk turns for the bow at most, radians.
const MOST_TURN: f64 = 1.2;

/// How softly arms reach, as a share of their length: they do not snap straight.
const SOFT: f64 = 0.97;

/// The hands on a sword, and how much they follow a grip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hands {
    pub(super) sword: JointId,
    /// The left hand is on the hilt as well.
    pub(super) both: bool,
    /// 0 for where the clip has them to 1 for the grip.
    pub(super) share: f64,
}

/// Brings the sword in the right hand to a grip, and the left hand along if it holds the sword as well.
pub(super) fn bring(
    figure: &Figure,
    pose: &mut Pose,
    hands: Hands,
    grip: &Grip,
) -> Result<(), IkError> {
    let (skeleton, humanoid) = (figure.skeleton(), figure.humanoid());
    let arms = [Side::Right, Side::Left].map(|side| humanoid.arm(side));
    let (Some(right), Some(left)) = (arms[0].end.joint(), arms[1].end.joint()) else {
        return Ok(());
    };
    let place = |pose: &Pose, joint: JointId| {
        let found = joint_in_model(skeleton, pose, joint);
        found.map(|found| (found.translation, rotation(&found)))
    };
    let (Some((wrist, turn)), Some((left_wrist, left_turn))) =
        (place(pose, right), place(pose, left))
    else {
        return Ok(());
    };
    let own = &pose.transforms[hands.sword.index()];
    let (offset, own_turn) = (own.translation.as_dvec3(), own.rotation.as_dquat());
    let now = wrist + turn * offset;
    let blade = turn * own_turn * DVec3::Y;
    let swung = grip.along.map_or(DQuat::IDENTITY, |along| {
        arc(blade, along, hands.share, core::f64::consts::PI)
    });
    let new_turn = (swung * turn).normalize();
    let held = now.lerp(grip.place, hands.share);
    let goal = TwoBoneGoal {
        soft: SOFT,
        ..TwoBoneGoal::reach(held - new_turn * offset)
    };
    arms[0].ik.solve(skeleton, pose, &goal, None)?;
    orient(skeleton, pose, right, new_turn)?;
    let Some((there, _)) = place(pose, right).filter(|_| hands.both) else {
        return Ok(());
    };
    // The left hand keeps its place on the hilt.
    let beside = there + swung * (left_wrist - wrist);
    let goal = TwoBoneGoal {
        soft: SOFT,
        ..TwoBoneGoal::reach(beside)
    };
    arms[1].ik.solve(skeleton, pose, &goal, None)?;
    orient(skeleton, pose, left, (swung * left_turn).normalize())
}

/// Turns the trunk so that a bow points along a unit vector in model space, by a share of the way.
pub(super) fn turn_trunk(
    figure: &Figure,
    pose: &mut Pose,
    bow: JointId,
    wanted: DVec3,
    share: f64,
) -> Result<(), IkError> {
    let (skeleton, humanoid) = (figure.skeleton(), figure.humanoid());
    let Some(bow) = turn_of(skeleton, pose, bow) else {
        return Ok(());
    };
    let gaze = turn_of(skeleton, pose, humanoid.head);
    let joints = [humanoid.spine.first().copied(), Some(humanoid.chest())];
    for joint in joints.into_iter().flatten() {
        let turn = arc(bow * DVec3::Z, wanted, 0.5 * share, 0.5 * MOST_TURN);
        if let Some(now) = turn_of(skeleton, pose, joint) {
            orient(skeleton, pose, joint, (turn * now).normalize())?;
        }
    }
    // The head looked at the giant already.
    match gaze {
        Some(gaze) => orient(skeleton, pose, humanoid.head, gaze),
        None => Ok(()),
    }
}

fn turn_of(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> Option<DQuat> {
    // A piece that is hidden has no rotation: its parent's and its own are taken apart from its scale.
    let parent = skeleton.joints()[joint.index()].parent;
    let parent = parent.and_then(|parent| joint_in_model(skeleton, pose, parent));
    let own = pose.transforms[joint.index()].rotation.as_dquat();
    Some(parent.map_or(own, |parent| rotation(&parent) * own))
}

/// The rotation of a joint that is not scaled.
fn rotation(place: &DAffine3) -> DQuat {
    let [x, y] = [place.matrix3.x_axis, place.matrix3.y_axis].map(DVec3::normalize_or_zero);
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

/// A share of the smallest turn from one direction to another, at most `most` radians.
fn arc(from: DVec3, to: DVec3, share: f64, most: f64) -> DQuat {
    let across = from.cross(to);
    let angle = libm::atan2(across.length(), from.dot(to)) * share;
    let axis = across.normalize_or(from.any_orthonormal_vector());
    rotation_from_axis_angle(axis, angle.min(most))
}
