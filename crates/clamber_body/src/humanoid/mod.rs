mod build;
mod find;
mod joint;
mod names;
mod reference;

use clamber_animation::ik::TwoBone;
use clamber_surface::rig::JointId;
use glam::{DAffine3, DVec3};

pub(crate) use find::depth;
pub use joint::{HumanJoint, Side};
pub(crate) use reference::reference;

/// A human body in a skeleton: the role of each joint, and limbs with their inverse kinematics.
///
/// [`Humanoid::find`] knows the names of Mixamo, Rigify, Quaternius, KayKit, VRM, Unreal and Godot, and numbered chains
/// such as `leg_joint_L_1`. For other skeletons, [`Humanoid::from_joints`] takes a list of joints.
///
/// ```
/// use clamber_body::{Humanoid, Side};
/// # use clamber_surface::{geometry::Affine, rig::*};
/// # let mut joints: Vec<Joint> = Vec::new();
/// # let mut add = |name: &str, parent: i32, at: [f32; 3]| joints.push(Joint {
/// #     name: name.into(), parent: u32::try_from(parent).ok().map(JointId), inverse_bind: Affine::IDENTITY,
/// #     rest: Transform::from_translation(at.into()),
/// # });
/// # add("Hips", -1, [0.0, 1.0, 0.0]); add("Spine", 0, [0.0, 0.3, 0.0]); add("Head", 1, [0.0, 0.4, 0.0]);
/// # for (side, x) in [("Left", 1.0), ("Right", -1.0)] {
/// #     let at = if x > 0.0 { 3 } else { 9 };
/// #     add(&format!("{side}Arm"), 1, [0.2 * x, 0.2, 0.0]); add(&format!("{side}ForeArm"), at, [0.3 * x, 0.0, 0.0]);
/// #     add(&format!("{side}Hand"), at + 1, [0.3 * x, 0.0, 0.0]); add(&format!("{side}UpLeg"), 0, [0.1 * x, 0.0, 0.0]);
/// #     add(&format!("{side}Leg"), at + 3, [0.0, -0.5, 0.0]); add(&format!("{side}Foot"), at + 4, [0.0, -0.5, 0.0]);
/// # }
/// # let skeleton = Skeleton::new(joints)?;
/// let body = Humanoid::find(&skeleton)?;
/// let left_hand = body.arm(Side::Left).end.joint();
/// assert_eq!(left_hand, skeleton.find("LeftHand"));
/// assert!(body.facing.z > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Humanoid {
    /// The joint that carries the spine and both legs.
    pub hips: JointId,
    /// The joints above the hips, from the bottom up. The last one is the chest, which carries both arms. Empty if the
    /// hips carry the arms.
    pub spine: Vec<JointId>,
    /// The joints between the chest and the head, both left out, from the bottom up; may be empty.
    pub neck: Vec<JointId>,
    /// The head's joint.
    pub head: JointId,
    /// The left and the right arm, in this order.
    pub arms: [Limb; 2],
    /// The left and the right leg, in this order.
    pub legs: [Limb; 2],
    /// Direction that the body faces in its bind pose: a level unit vector in model space. +Z in most files.
    pub facing: DVec3,
}

/// An arm or a leg.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Limb {
    /// The collar bone of an arm, if the skeleton has one; `None` for legs.
    pub shoulder: Option<JointId>,
    /// The joint of the upper arm or thigh.
    pub upper: JointId,
    /// The joint of the forearm or shin.
    pub lower: JointId,
    /// The hand or foot at the end of the limb: a joint, or a point.
    pub end: LimbEnd,
    /// The joint of a leg's toes, if the skeleton has one; `None` for arms.
    pub toes: Option<JointId>,
    /// The joints of each finger, from the palm to the tip, found by their names below the forearm; empty for legs. The
    /// thumb tells which way the palm faces; a body does not move the fingers.
    pub fingers: Vec<Vec<JointId>>,
    /// Inverse kinematics that bring the end to a target.
    pub ik: TwoBone,
    /// Lengths of the upper and the lower bone in the bind pose, in model units.
    pub lengths: [f64; 2],
}

/// How the skeleton gives the hand or foot at the end of a limb: as a joint below the limb, as a joint elsewhere, or as
/// a mere point. It does not tell a hand from a foot: an arm ends in a hand, a leg in a foot.
/// [`Extremity`](crate::Extremity) names one of the four hands and feet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimbEnd {
    /// The joint of the hand or foot, which is below the lower bone in the skeleton and moves with it.
    Joint(JointId),
    /// The joint of the hand or foot, if it is not below the limb in the skeleton, as in files with baked controls.
    /// Code that poses the limb has to move this joint to the given point, which is in the space of the lower bone,
    /// model units.
    Beside(JointId, DVec3),
    /// No joint, but a point between several joints: a hand that consists of fingers alone. The point is in the space
    /// of the lower bone, model units.
    Point(DVec3),
}

impl LimbEnd {
    /// The joint of the hand or foot, if there is one.
    pub fn joint(&self) -> Option<JointId> {
        match self {
            Self::Joint(joint) | Self::Beside(joint, _) => Some(*joint),
            Self::Point(_) => None,
        }
    }

    /// Where the hand or foot is, when `models` has the skeleton's joints in model space, and `lower` is the lower
    /// bone's joint.
    pub(crate) fn place(&self, lower: JointId, models: &[DAffine3]) -> DVec3 {
        match self {
            Self::Joint(joint) | Self::Beside(joint, _) => models[joint.index()].translation,
            Self::Point(point) => models[lower.index()].transform_point3(*point),
        }
    }
}

impl Limb {
    /// The length of the straight limb in the bind pose, in model units: from the shoulder joint to the wrist, or from
    /// the hip joint to the ankle.
    pub fn length(&self) -> f64 {
        self.lengths[0] + self.lengths[1]
    }
}

impl Humanoid {
    /// The joint that carries both arms: the last joint of the spine, or the hips.
    pub fn chest(&self) -> JointId {
        self.spine.last().copied().unwrap_or(self.hips)
    }

    /// The arm on one side of the body.
    pub fn arm(&self, side: Side) -> &Limb {
        &self.arms[side.index()]
    }

    /// The leg on one side of the body.
    pub fn leg(&self, side: Side) -> &Limb {
        &self.legs[side.index()]
    }

    /// The role of a joint; `None` if it is not one of the body's named joints.
    pub fn role(&self, joint: JointId) -> Option<HumanJoint> {
        self.joints()
            .into_iter()
            .find_map(|(role, found)| (found == joint).then_some(role))
    }

    /// The named joints of this body with their roles, from the hips outward.
    pub fn joints(&self) -> Vec<(HumanJoint, JointId)> {
        let mut all = vec![(HumanJoint::Hips, self.hips)];
        if !self.spine.is_empty() {
            all.push((HumanJoint::Chest, self.chest()));
        }
        all.extend(self.neck.first().map(|neck| (HumanJoint::Neck, *neck)));
        all.push((HumanJoint::Head, self.head));
        for side in Side::BOTH {
            let (arm, leg) = (self.arm(side), self.leg(side));
            let some = [
                (HumanJoint::Shoulder(side), arm.shoulder),
                (HumanJoint::UpperArm(side), Some(arm.upper)),
                (HumanJoint::LowerArm(side), Some(arm.lower)),
                (HumanJoint::Hand(side), arm.end.joint()),
                (HumanJoint::UpperLeg(side), Some(leg.upper)),
                (HumanJoint::LowerLeg(side), Some(leg.lower)),
                (HumanJoint::Foot(side), leg.end.joint()),
                (HumanJoint::Toes(side), leg.toes),
            ];
            all.extend(
                some.into_iter()
                    .filter_map(|(role, joint)| Some((role, joint?))),
            );
        }
        all
    }
}
