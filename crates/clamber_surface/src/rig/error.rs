use thiserror::Error;

use super::JointId;

/// The reason why a skeleton, pose or clip was rejected. The call changed nothing.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RigError {
    /// The parent of a joint does not exist.
    #[error("joint {joint}'s parent is {parent}, but there are only {joints} joints")]
    ParentOutOfRange {
        /// The joint.
        joint: JointId,
        /// Its parent.
        parent: JointId,
        /// Number of joints.
        joints: usize,
    },
    /// Following parents from this joint leads back to it.
    #[error("joint {0} is its own ancestor")]
    Cycle(JointId),
    /// A transform, matrix, key frame, time or blend weight is infinite or NaN, or a rotation has length zero.
    #[error("{what} is not finite, or has a rotation of length zero")]
    NotFinite {
        /// Name of the value.
        what: String,
    },
    /// A pose does not have as many joints as the skeleton or the other pose, or a stored palette does not have one
    /// joint transform per matrix.
    #[error("expected {expected} joints, found {found}")]
    JointCount {
        /// Number of joints of the skeleton or of the first pose, or of matrices of the palette.
        expected: usize,
        /// Number of joints of the pose, or of joint transforms of the palette.
        found: usize,
    },
    /// A channel moves a joint that the pose does not have.
    #[error("a channel moves joint {joint}, but there are only {joints} joints")]
    JointOutOfRange {
        /// The channel's joint.
        joint: JointId,
        /// Number of joints of the pose.
        joints: usize,
    },
    /// A channel has no key frames, or the number of values does not fit the number of times.
    #[error(
        "a channel needs at least one time, and {expected} values for {times} times; found {found}"
    )]
    KeyframeCount {
        /// Number of times.
        times: usize,
        /// Number of values that these times need: one per time, or three per time for a cubic spline.
        expected: usize,
        /// Number of values found.
        found: usize,
    },
    /// The times of the key frames decrease.
    #[error("key frame {index} has an earlier time than the key frame before it")]
    TimesNotSorted {
        /// Index of the key frame that has the earlier time.
        index: usize,
    },
    /// A time is earlier than the time before it.
    #[error("{what} is {time} s, which is before {last} s")]
    TimeGoesBack {
        /// Name of the time.
        what: &'static str,
        /// The time, seconds.
        time: f64,
        /// The time before it, seconds.
        last: f64,
    },
    /// A tick asks for a pose before there is one.
    #[error("no pose has been recorded yet")]
    NoPose,
    /// The map from model space to the world has a part that is not finite, a scale that is not positive, or a rotation
    /// whose length is not 1.
    #[error("world_from_model is not a valid similarity")]
    WorldFromModel,
    /// A marker's time is not within its clip.
    #[error("marker {name:?} is at {time} s, but the clip lasts {duration} s")]
    MarkerOutOfRange {
        /// Name of the marker.
        name: String,
        /// Time of the marker, seconds after the clip's first key frame.
        time: f64,
        /// Duration of the clip, seconds.
        duration: f64,
    },
}
