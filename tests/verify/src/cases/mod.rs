//! Test cases for sweeps: hard cases, and cases whose answer is partly known.

mod adversarial;
mod constructed;
mod place;

pub use adversarial::{KINDS, Kind, adversarial};
pub use constructed::{Known, constructed};

use crate::MovingPair;

/// A test case for a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The moving triangle and sphere or capsule.
    pub pair: MovingPair,
    /// Tolerance of the sweep: how much the distance at a hit may exceed the radius.
    pub tolerance: f32,
}
