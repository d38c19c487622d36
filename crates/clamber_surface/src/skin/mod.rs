//! Linear blend skinning on the CPU, with the same bits everywhere.
//!
//! A skinned vertex is `p' = sum_k w_k (M_k p)` over its influences in ascending joint order. Each
//! row of `M_k p` is `((m0 x + m1 y) + (m2 z + m3))`; no operation is fused; the sum starts from +0
//! and runs in that order. Weights are integers times 2^-24 with a sum of exactly 1. Influences of
//! weight zero would then add nothing, so any kernel that keeps to this order gives the same bits,
//! whatever it pads or vectorises.
//!
//! The fast kernel skins a cluster of up to 64 vertices at a time, as many at once as the machine is wide
//! ([`crate::SimdLevel`]): a list of the cluster's joints, and per joint a row of weights, zero where it
//! does not move a vertex, so that nothing is gathered. Tests compare it with a plain scalar loop.
//!
//! Against exact arithmetic on the same f32 palette each coordinate of a vertex with n influences
//! is off by at most `(n + 4) 2^-24 sum_k w_k (|M_k| |p| + |t_k|)`, plus `(4 n + 4) 2^-149` where
//! products underflow.

mod cluster;
#[cfg(feature = "rayon")]
mod parallel;
pub(crate) mod reference;
mod scalar;
pub(crate) mod whole;

pub(crate) use cluster::{ClusterPositions, skin_cluster};
pub(crate) use scalar::skin_vertex;
pub(crate) use whole::skin_checked;
pub use whole::{skin, skin_into};

#[cfg(test)]
mod tests;
