use thiserror::Error;

use super::JointId;

/// Why a skeleton, pose or clip was refused. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RigError {
    /// A joint names a parent that does not exist.
    #[error("joint {joint}'s parent is {parent}, but there are only {joints} joints")]
    ParentOutOfRange {
        /// The joint.
        joint: JointId,
        /// What it names as its parent.
        parent: JointId,
        /// How many joints there are.
        joints: usize,
    },
    /// Following parents from this joint leads back to it.
    #[error("joint {0} is its own ancestor")]
    Cycle(JointId),
    /// A transform, matrix, key frame or time is infinite, NaN or a rotation without length.
    #[error("{what} is not finite, or is a rotation of length zero")]
    NotFinite {
        /// Which value.
        what: String,
    },
    /// A pose has another number of joints than the skeleton or than the other pose.
    #[error("expected {expected} joints, found {found}")]
    JointCount {
        /// As the skeleton has.
        expected: usize,
        /// As the pose has.
        found: usize,
    },
    /// A channel moves a joint that the pose does not have.
    #[error("a channel moves joint {joint}, but there are only {joints} joints")]
    JointOutOfRange {
        /// The channel's joint.
        joint: JointId,
        /// How many joints there are.
        joints: usize,
    },
    /// A channel has no key frames, or another number of values than of times.
    #[error("a channel with {times} times needs {expected} values, found {found}")]
    KeyframeCount {
        /// Number of times.
        times: usize,
        /// Values that so many times need: as many, or three times as many for a cubic spline.
        expected: usize,
        /// Values found.
        found: usize,
    },
    /// Key frame times run backwards.
    #[error("key frame {index} comes before the one in front of it")]
    TimesNotSorted {
        /// Index of the later key frame.
        index: usize,
    },
}
