use clamber_animation::AnimationError;
use clamber_animation::ik::IkError;
use thiserror::Error;

/// Why [`Body::update`](crate::Body::update) failed. The body keeps its place.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
    /// A number of the frame is infinite or NaN.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// The time since the last frame is negative, or not finite.
    #[error("the time since the last frame is {0} s; it must be finite and not negative")]
    Time(f64),
    /// The body was made for another figure.
    #[error("the body has {body} joints, the figure {figure}")]
    OtherFigure {
        /// Joints of the body.
        body: usize,
        /// Joints of the figure.
        figure: usize,
    },
    /// A layer names a clip or a mask that the figure does not have.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A limb cannot be posed, such as one that a clip scales to nothing.
    #[error(transparent)]
    Ik(#[from] IkError),
}
