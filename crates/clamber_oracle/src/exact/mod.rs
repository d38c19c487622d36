//! Distances in rational numbers, and proofs that the answer of a sweep is right or wrong.

mod certificate;
mod nearest;
mod number;
mod pair;
mod tally;
mod verdict;

pub use certificate::{Apart, Last, Motion};
pub use number::{
    Exact, between, between_triangle_and_segment, dot, exact, from_triangle, length_sq, minus,
    number, plus, rounded,
};
pub use pair::ExactPair;
pub use tally::Tally;
pub use verdict::{Claim, Verdict};
