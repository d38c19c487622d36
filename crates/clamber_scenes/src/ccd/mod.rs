//! Continuous collision queries with exact answers: what sweeps are judged by.
//!
//! - [`exact`]: distances in rational numbers.
//! - [`MovingPair`]: a moving triangle and a moving sphere or capsule; [`Stage`] poses it and asks the
//!   library.
//! - [`Motion`] proves for stretches of time that the two are apart; a [`Claim`] is what a sweep says,
//!   and what is to be checked.
//! - [`cases`]: pairs that are hard, or of which something is known, and counts of answers.
//! - [`queries`]: queries from files, whose answers are known.

pub mod cases;
mod certificate;
pub mod exact;
mod nearest;
mod pair;
pub mod queries;
mod stage;
mod verdict;

pub use certificate::{Apart, Last, Motion};
pub use pair::{Core, ExactPair, MovingPair};
pub use stage::{Answer, Stage};
pub use verdict::{Claim, Verdict};
