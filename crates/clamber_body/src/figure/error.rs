use clamber_animation::AnimationError;
use clamber_animation::ik::IkError;
use clamber_surface::rig::RigError;
use thiserror::Error;

/// Why [`Figure::new`](crate::Figure::new) or [`Figure::with_scale`](crate::Figure::with_scale) failed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FigureError {
    /// No clip is called `idle`.
    #[error(
        "no clip is called idle; give the clips the names of BodyClip, or carry over another figure's by Retarget"
    )]
    NoIdle,
    /// The scale is not a finite number above 0.
    #[error("the scale is {0}; it must be finite and more than 0")]
    Scale(f64),
    /// A clip moves joints that the skeleton does not have, or a clip has bad numbers.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// The humanoid belongs to another skeleton.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The inverse kinematics cannot turn the head.
    #[error("the head: {0}")]
    Ik(#[from] IkError),
}
