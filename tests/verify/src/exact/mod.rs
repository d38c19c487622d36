//! Distances in rational numbers, and proofs that the answer of a sweep is right or wrong.
//!
//! ```
//! use clamber_verify::exact::Claim;
//! use clamber_verify::glam::Vec3;
//! use clamber_verify::MovingPair;
//!
//! // A ball of 0.25 m falls by 2 m, from 1 m above a triangle at rest: it touches after 0.75 m, at 0.375 of the way.
//! let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
//! let pair = MovingPair {
//!     corners: [corners; 2],
//!     ends: [Vec3::new(0.25, 1.0, 0.25); 2],
//!     motions: [Vec3::Y * -2.0; 2],
//!     radius: 0.25,
//! };
//! let claim = |time| Claim { time, undecided: false };
//!
//! let right = claim(Some(0.375)).check(&pair, 1e-4);
//! assert!(right.near && !right.is_late());
//! assert!(claim(Some(0.4)).check(&pair, 1e-4).is_late());
//! assert!(claim(None).check(&pair, 1e-4).is_late());
//! assert!(!claim(Some(0.3)).check(&pair, 1e-4).near);
//! ```

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

/// The rational numbers of this module.
pub use dashu_ratio::Relaxed;
