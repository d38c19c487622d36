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
    /// A joint does not exist.
    #[error("{what} is joint {joint}, but there are only {joints} joints")]
    NoJoint {
        /// What it was named for.
        what: HumanJoint,
        /// The joint.
        joint: JointId,
        /// Number of joints.
        joints: usize,
    },
    /// Two joints were named for one thing, or one joint for two.
    #[error("{what} is named twice, or its joint is also another's")]
    Twice {
        /// What is named twice.
        what: HumanJoint,
    },
    /// A joint is not below the one that it should hang from.
    #[error("{what} is not below {above}")]
    NotBelow {
        /// The joint.
        what: HumanJoint,
        /// The joint that should be above it.
        above: HumanJoint,
    },
    /// Both legs begin at the same place, so that nobody knows where the body faces.
    #[error("the legs are not beside each other at rest")]
    NoFacing,
    /// A limb cannot be bent.
    #[error("the limb from {limb}: {error}")]
    Limb {
        /// The limb's first joint.
        limb: HumanJoint,
        /// Why not.
        error: IkError,
    },
}

fn listed(joints: &[HumanJoint]) -> String {
    let names: Vec<String> = joints.iter().map(HumanJoint::to_string).collect();
    names.join(", ")
}
