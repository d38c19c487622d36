//! Linear blend skinning on the CPU, with the same bits on every machine.
//!
//! A skinned vertex is `p' = sum_k w_k (M_k p)` over its influences in ascending joint order. Each row of `M_k p` is
//! `((m0 x + m1 y) + (m2 z + m3))`. No operation is fused. The sum starts from +0 and runs in joint order. Weights are
//! integers times 2^-24 that add up to exactly 1. An influence of weight zero would add nothing, so any kernel that
//! keeps to this order gives the same bits, with any padding and vectorisation.
//!
//! The fast kernel skins a cluster of up to 64 vertices at a time, as many of them at once as fit a SIMD vector
//! ([`crate::SimdLevel`]). A cluster has a list of its joints, and per joint a row of weights, which are zero where
//! the joint does not move a vertex. So the kernel needs no gathers. Tests compare it with a plain scalar loop.
//!
//! Compared with exact arithmetic on the same f32 palette, each coordinate of a vertex with n influences is off by
//! at most `(n + 4) 2^-24 sum_k w_k (|M_k| |p| + |t_k|)`, plus `(4 n + 4) 2^-149` where products underflow.

mod cluster;
#[cfg(feature = "rayon")]
mod parallel;
pub(crate) mod reference;
mod scalar;
pub(crate) mod whole;

pub(crate) use cluster::{ClusterPositions, SkinnedCluster};
pub(crate) use scalar::skin_vertex;
pub(crate) use whole::skin_checked;
pub use whole::{skin, skin_into};

#[cfg(test)]
mod tests;
