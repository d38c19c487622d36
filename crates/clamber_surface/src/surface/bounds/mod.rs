//! Bounds of skinned vertices from the palette alone: no vertex is skinned.
//!
//! A skinned vertex is `p' = sum w_i M_i p` with `w_i >= 0`, `sum w_i = 1`, `M_i p = A_i p + t_i`.
//! Let the vertices of a node lie at rest in the ball (c, r), let `w_i` lie within `[low_i, high_i]`
//! over all of them, and let `s_i` be at least the largest singular value of `A_i`.
//!
//! - **Hull**: `M_i p` lies in the ball `(M_i c, s_i r)`, so p' lies in the convex hull of these
//!   balls, and in every ball that holds them all.
//! - **Weight interval**: choose fixed `o_i` that add up to exactly 1, here the middles of the
//!   intervals, renormalised to multiples of 2^-24; let `d_i = max(high_i - o_i, o_i - low_i)` and
//!   `c' = sum o_i M_i c`. Since `sum (w_i - o_i) = 0`,
//!   `p' - c' = sum w_i A_i (p - c) + sum (w_i - o_i) (M_i c - c')`,
//!   so p' lies within `r max s_i + sum d_i |M_i c - c'|` of c'. Where all vertices have the same
//!   weights the second term is 0.
//! - **Capsule**: at rest `p = s + q` with s on the segment from a to b and `|q| <= r`. Put s for c
//!   above: `p' = s' + sum w_i A_i q + sum (w_i - o_i) (M_i s - s')` with `s' = sum o_i M_i s`, which
//!   runs along the segment from a' to b' as s runs from a to b. `sum d_i |M_i s - s'|` is a sum of
//!   lengths of affine functions of s, hence convex along the segment, and largest at one of its
//!   ends: p' lies in the capsule about a'b' of radius `r max s_i + max over the two ends e of
//!   sum d_i |M_i e - e'|`. By the hull's argument it also lies in the one of radius
//!   `max_i (s_i r + max over the two ends e of |M_i e - e'|)`; the smaller radius counts.
//!
//! All this holds for exact skinning. What f32 skinning yields is off by at most
//! `(n + 4) 2^-24 sum w_i (|A_i| |p| + |t_i|)` per coordinate and some underflow
//! ([`crate::skin::error_bound`]); the norm of `|A_i|`, element by element, is at most that of
//! Frobenius, at most `sqrt(3) s_i`. So every radius is inflated by
//! `sqrt(3) (n + m + 12) 2^-24 max_i (s_i max |p| + |t_i|) + sqrt(3) (4 n + 4) 2^-149`
//! for n influences of a vertex and m joints of the node. `n + 4` of it pays for the skinning. The
//! bounds themselves are computed in f64, where some `8 m` roundings of 2^-53 come to nothing
//! beside the remaining `m + 8`. Centres are rounded to f32 last, and radii
//! grow by exactly what that moves them, upwards.
//!
//! f64 because this is the reference for faster forms, and because creatures stand a kilometre from
//! their origin. It costs O(joints of the node), in any order.
//!
//! Kavan and Zara 2005 ("Fast Collision Detection for Skeletally Deformable Models", Computer
//! Graphics Forum 24(3)) refit spheres of linear blend skinning by the hull argument;
//! Unterguggenberger, Kerbl, Pernsteiner and Wimmer 2021 ("Conservative Meshlet Bounds for Robust
//! Culling of Skinned Meshes", Computer Graphics Forum 40(7)) bound meshlets.

mod eight;
mod joint_maps;
mod joint_table;
mod node;
#[cfg(test)]
mod pack;
mod part;
mod root;

pub use crate::mesh::hierarchy::WeightInterval;
pub(crate) use eight::{Spheres, inflation, spheres};
pub use joint_maps::JointMaps;
pub(crate) use joint_table::JointTable;
pub use node::NodeBounds;
#[cfg(test)]
use pack::push_node;
pub use part::PartBounds;
pub(crate) use root::{RootBalls, RootBox};

#[cfg(test)]
pub(crate) mod tests;
