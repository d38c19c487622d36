use clamber_animation::AnimationError;
use clamber_animation::rig::RigError;
use clamber_surface::surface::SurfaceError;
use thiserror::Error;

use crate::brain::BrainError;

/// Why a creature was refused, or does not go on. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ColossusError {
    /// The brain is at fault.
    #[error(transparent)]
    Brain(#[from] BrainError),
    /// The clips do not fit the skeleton.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A pose does not fit the skeleton.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The skin cannot be posed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// A number is infinite, NaN or out of its range.
    #[error("{what} is {found}, which is not {range}")]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// The range that it must be in.
        range: &'static str,
        /// The number.
        found: f64,
    },
    /// A state was saved by a creature of another kind.
    #[error("the state is of another kind of creature: {0}")]
    OtherKind(&'static str),
}
