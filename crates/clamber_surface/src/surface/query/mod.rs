//! Queries on the posed surface. All are in model space and see triangles from both sides.
//!
//! A query descends the hierarchy by spheres that come from the palette alone, has the clusters
//! skinned that it reaches, rules out most of their triangles by their boxes, and tests the others
//! exactly, in f64 on the f32 corners. Bounds only ever rule out what the exact test would refuse, so
//! the answer is that of testing every triangle, bit for bit.

mod broad;
mod closest;
mod cluster_view;
mod hit;
mod inside;
mod narrow;
mod overlap;
mod planes;
mod posed_cluster;
mod ray;
mod region;
mod root;
mod stack;
mod sweep;

pub use closest::CapsuleHit;
pub(super) use closest::{capsule_hit, reach};
pub use hit::SurfaceHit;
pub(super) use hit::{Best, Nearest, by_length};
pub(super) use region::{Region, check_point};
pub(super) use sweep::{Earliest, First, Sweep, sort_by_time};
pub use sweep::{MovingTriangle, SweepHit};

use super::SurfaceError;

/// Refuses lengths that are NaN or negative; infinity is a length.
pub(super) fn check_length(what: &'static str, length: f32) -> Result<f64, SurfaceError> {
    if length >= 0.0 {
        Ok(f64::from(length))
    } else {
        Err(SurfaceError::Query {
            what,
            range: "not negative",
            found: f64::from(length),
        })
    }
}

#[cfg(test)]
mod tests;
