use clamber_animation::AnimationError;
use clamber_animation::rig::RigError;
use clamber_surface::surface::SurfaceError;
use thiserror::Error;

use crate::brain::BrainError;

/// Why a creature was refused, or cannot go on. Building, restoring or placing a creature changes nothing if it fails.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ColossusError {
    /// The brain file is invalid, or does not fit the creature.
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
        /// The name of the number.
        what: &'static str,
        /// The allowed range.
        range: &'static str,
        /// The number found.
        found: f64,
    },
    /// A state that was saved by a creature of another kind.
    #[error("the state is of another kind of creature: {0}")]
    OtherKind(&'static str),
}
