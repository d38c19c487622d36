use clamber_animation::ik::IkError;
use clamber_surface::rig::JointId;
use thiserror::Error;

use crate::HumanJoint;

/// Why a skeleton cannot be used as a human body.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HumanoidError {
    /// Joints that a body needs were not found.
    #[error("no joint was found for {}; name them with Humanoid::from_joints", listed(.0))]
    Missing(Vec<HumanJoint>),
    /// A named joint does not exist in the skeleton.
    #[error("{what} is joint {joint}, but there are only {joints} joints")]
    NoJoint {
        /// The body's joint that was named.
        what: HumanJoint,
        /// The id that the skeleton lacks.
        joint: JointId,
        /// Number of joints in the skeleton.
        joints: usize,
    },
    /// One body joint was named twice, or one id was given to two body joints.
    #[error("{what} is named twice, or its joint is also another's")]
    Twice {
        /// The body joint that repeats a name or an id.
        what: HumanJoint,
    },
    /// A joint is not a descendant of the joint that should carry it.
    #[error("{what} is not below {above}")]
    NotBelow {
        /// The joint.
        what: HumanJoint,
        /// The joint that should be above it.
        above: HumanJoint,
    },
    /// Seen from above, both legs begin at the same point, so that the facing is unknown.
    #[error("the legs are not beside each other at rest")]
    NoFacing,
    /// The inverse kinematics refuse a limb.
    #[error("the limb from {limb}: {error}")]
    Limb {
        /// The limb's first joint.
        limb: HumanJoint,
        /// The reason.
        error: IkError,
    },
}

fn listed(joints: &[HumanJoint]) -> String {
    let names: Vec<String> = joints.iter().map(HumanJoint::to_string).collect();
    names.join(", ")
}
