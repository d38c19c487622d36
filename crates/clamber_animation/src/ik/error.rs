use clamber_surface::rig::JointId;
use thiserror::Error;

/// Why a solver refused its input. The pose is unchanged.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IkError {
    /// A target, direction, pole, weight or pose is infinite or NaN.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// A joint does not exist, or the pose has another number of joints than the skeleton.
    #[error("joint {joint} is out of range: there are {joints} joints")]
    NoJoint {
        /// The joint, or the pose's number of joints if that number does not fit.
        joint: JointId,
        /// Number of joints in the skeleton.
        joints: usize,
    },
    /// A joint of a chain is not below the joint before it.
    #[error("joint {joint} is not below joint {ancestor}")]
    NotAChain {
        /// The joint.
        joint: JointId,
        /// The joint that should be its ancestor.
        ancestor: JointId,
    },
    /// The bone that ends at this joint has no length.
    #[error("the bone to joint {0} has no length")]
    NoLength(JointId),
    /// The joint or one of its parents is scaled by 0.
    #[error("joint {0} or a parent of it is scaled by 0")]
    NotInvertible(JointId),
    /// The joint or one of its parents scales unevenly, so that a rotation does not keep the lengths of bones.
    #[error("joint {0} or a parent of it scales its axes unevenly")]
    Sheared(JointId),
    /// The set-up is invalid: for example, an axis has no length, or a limit is out of its range.
    #[error("{0}")]
    BadSetUp(&'static str),
}
