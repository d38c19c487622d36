//! Moving pairs to put to a sweep, and counts of what it answers.

mod adversarial;
mod constructed;
mod place;
mod tally;

pub use adversarial::{KINDS, Kind, adversarial};
pub use constructed::{Known, constructed};
pub use tally::{CAP, Tally};

use super::pair::MovingPair;

/// A pair, and how near a sweep has to come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What moves.
    pub pair: MovingPair,
    /// Of the sweep.
    pub tolerance: f32,
}
