use clamber_animation::AnimationError;
use clamber_animation::ik::IkError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// Why something is no [`Figure`](crate::Figure).
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FigureError {
    /// No clip to stand in.
    #[error(
        "no clip is called idle; give the clips the names of BodyClip, or carry over another figure's by Retarget"
    )]
    NoIdle,
    /// The scale is not finite and more than 0.
    #[error("the scale is {0}; it must be finite and more than 0")]
    Scale(f64),
    /// A clip moves joints that the skeleton does not have, or a clip has bad numbers.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// The humanoid is another skeleton's.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The head cannot be turned.
    #[error("the head: {0}")]
    Ik(#[from] IkError),
}
