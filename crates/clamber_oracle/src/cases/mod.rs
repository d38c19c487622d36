//! Moving pairs for sweeps to answer: hard ones, and ones whose answer is known in part.

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
