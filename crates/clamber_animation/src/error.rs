use clamber_surface::rig::{JointId, RigError};
use thiserror::Error;

use crate::ClipId;

/// Why a call was refused. The animator or the set is then unchanged.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum AnimationError {
    /// An animator names a clip that its set does not have.
    #[error("there is no clip {found}: the set has {clips}")]
    NoClip {
        /// The clip.
        found: ClipId,
        /// Number of clips in the set.
        clips: usize,
    },
    /// An animator names a mask that its set does not have.
    #[error("there is no mask {found}: the set has {masks}")]
    NoMask {
        /// Index of the mask.
        found: u32,
        /// Number of masks in the set.
        masks: usize,
    },
    /// A layer of an animator does not exist.
    #[error("there is no layer {found}: the animator has {layers}")]
    NoLayer {
        /// Index of the layer.
        found: usize,
        /// Number of layers.
        layers: usize,
    },
    /// A joint does not exist.
    #[error("there is no joint {found}: the skeleton has {joints}")]
    NoJoint {
        /// The joint.
        found: JointId,
        /// Number of joints.
        joints: usize,
    },
    /// A mask, pose or restored animator is for another number of joints.
    #[error("expected {expected} joints, found {found}")]
    JointCount {
        /// Number of joints of the skeleton.
        expected: usize,
        /// Number of joints found.
        found: usize,
    },
    /// A number is infinite, NaN or out of its range.
    #[error("{what} is {found}, which is not {range}")]
    OutOfRange {
        /// Name of the number.
        what: &'static str,
        /// The range that it must be in.
        range: &'static str,
        /// The value that was found.
        found: f64,
    },
    /// A pose or clip does not fit the skeleton.
    #[error(transparent)]
    Rig(#[from] RigError),
}

/// Refuses numbers that are not finite.
pub(crate) fn finite(what: &'static str, found: f64) -> Result<(), AnimationError> {
    within(what, "finite", found, f64::MIN, f64::MAX)
}

/// Refuses numbers below `least` or above `most`, and NaN. `range` names the range in the message.
pub(crate) fn within(
    what: &'static str,
    range: &'static str,
    found: f64,
    least: f64,
    most: f64,
) -> Result<(), AnimationError> {
    if (least..=most).contains(&found) {
        Ok(())
    } else {
        Err(AnimationError::OutOfRange { what, range, found })
    }
}
