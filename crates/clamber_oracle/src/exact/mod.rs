//! Distances in rational numbers, and proofs that the answer of a sweep is right or wrong.

mod arithmetic;
mod certificate;
mod nearest;
mod pair;
mod tally;
mod verdict;

pub use arithmetic::{
    Exact, between, between_triangle_and_segment, dot, exact, from_triangle, length_sq, minus,
    number, plus, rounded,
};
pub use certificate::{Apart, Last, Motion};
pub use pair::ExactPair;
pub use tally::Tally;
pub use verdict::{Claim, Verdict};
