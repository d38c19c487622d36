//! Moving pairs to put to a sweep: hard ones, and such of which something is known.

mod adversarial;
mod constructed;
mod place;

pub use adversarial::{KINDS, Kind, adversarial};
pub use constructed::{Known, constructed};

use crate::MovingPair;

/// A pair, and how near a sweep has to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What moves.
    pub pair: MovingPair,
    /// Of the sweep.
    pub tolerance: f32,
}
