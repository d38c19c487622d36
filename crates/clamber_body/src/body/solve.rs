//! Solves a limb's joints for the desired place of its hand or foot.

use clamber_animation::ik::{IkError, ReachResult, TwoBoneGoal, aim};
use clamber_animation::{ik::PoleMemory, joint_in_model};
use clamber_surface::rig::Pose;
use glam::{DAffine3, DVec3};

use super::root::Root;
use crate::figure::{LimbShape, Place};
use crate::{Figure, LimbEnd};

/// The goal of a limb.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// Desired place of the hand or foot, in world space.
    pub(crate) place: Place,
    /// Share of the limb's length from which a far place is approached softly; 1 for never.
    pub(crate) soft: f64,
}

/// Turns the joints of a limb, and its hand or foot. Returns the reached place.
pub(crate) fn limb(
    figure: &Figure,
    pose: &mut Pose,
    root: &Root,
    shape: &LimbShape,
    wanted: &Wanted,
    (pole, dt): (&mut PoleMemory, f64),
) -> Result<Place, IkError> {
    let (skeleton, scale) = (figure.skeleton(), figure.scale());
    let target = root.inverse_point(wanted.place.position) / scale;
    let goal = TwoBoneGoal {
        target,
        pole: None,
        soft: wanted.soft,
    };
    let reach = shape.ik.solve(skeleton, pose, &goal, Some((pole, dt)))?;
    if let LimbEnd::Beside(joint, point) = shape.end {
        let lower = joint_in_model(skeleton, pose, shape.lower).unwrap_or_default();
        let parent = skeleton.joints()[joint.index()].parent;
        let parent = parent.and_then(|parent| joint_in_model(skeleton, pose, parent));
        let inverse = parent.unwrap_or(DAffine3::IDENTITY).inverse();
        let local = inverse.transform_point3(lower.transform_point3(point));
        if local.is_finite() {
            pose.transforms[joint.index()].translation = local.as_vec3();
        }
    }
    if let Some(joint) = shape.end.joint() {
        let turn = root.rotation.conjugate() * wanted.place.rotation;
        let directions = [turn * DVec3::Y, turn * DVec3::X];
        // A hand below joints with uneven scale keeps the rotation of the clips' pose.
        match aim(skeleton, pose, joint, shape.aim_axes(), directions) {
            Ok(()) | Err(IkError::Sheared(_) | IkError::NotInvertible(_)) => {}
            Err(error) => return Err(error),
        }
    }
    let position = match reach {
        ReachResult::Reached => wanted.place.position,
        ReachResult::Short(_) | ReachResult::TooNear(_) => {
            root.point(shape.ik.end(skeleton, pose)? * scale)
        }
    };
    Ok(Place {
        position,
        ..wanted.place
    })
}
