use clamber_animation::AnimationError;
use clamber_animation::ik::IkError;
use clamber_surface::rig::{JointId, RigError};
use thiserror::Error;

use crate::HumanJoint;

/// Why a skeleton cannot be used as a human body, clips cannot be carried over, or a body cannot be updated.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
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
    /// The inverse kinematics cannot turn the head.
    #[error("the head: {0}")]
    Head(IkError),
    /// No clip is called `idle`.
    #[error(
        "no clip is called idle; give the clips the names of BodyClip, or carry over another figure's by Retarget"
    )]
    NoIdle,
    /// The scale of a figure is not a finite number above 0.
    #[error("the scale is {0}; it must be finite and more than 0")]
    Scale(f64),
    /// The legs of a body have no length.
    #[error("the legs have no length")]
    NoLegs,
    /// A number of the frame is infinite or NaN.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// The time since the last frame is negative, or not finite.
    #[error("the time since the last frame is {0} s; it must be finite and not negative")]
    Time(f64),
    /// The body was made for another figure, with another number of joints. Figures with equally many joints are not
    /// told apart.
    #[error("the body has {body} joints, the figure {figure}")]
    OtherFigure {
        /// Joints of the body.
        body: usize,
        /// Joints of the figure.
        figure: usize,
    },
    /// A clip moves joints that the skeleton does not have, a clip has bad numbers, or a layer names a clip or a mask
    /// that the figure does not have.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A skeleton does not have its body's joints, or a clip or a pose does not fit the skeleton.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A limb cannot be posed, such as one that a clip scales to nothing.
    #[error(transparent)]
    Ik(#[from] IkError),
}

fn listed(joints: &[HumanJoint]) -> String {
    let names: Vec<String> = joints.iter().map(HumanJoint::to_string).collect();
    names.join(", ")
}
