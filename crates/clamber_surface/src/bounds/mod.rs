//! Bounds of skinned vertices from the palette alone: no vertex is skinned.
//!
//! Let the rest positions of a node's vertices lie in the ball (c, r), let `w_i` lie within `[low_i, high_i]` over
//! all of them, and let `s_i` be at least the largest singular value of `A_i`.
//!
//! - **Hull**: `M_i p` lies in the ball `(M_i c, s_i r)`, so p' lies in the convex hull of these
//!   balls, and in every ball that holds them all.
//! - **Weight interval**: choose fixed `o_i` that add up to exactly 1, here the middles of the
//!   intervals, renormalised to multiples of 2^-24; let `d_i = max(high_i - o_i, o_i - low_i)` and
//!   `c' = sum o_i M_i c`. Since `sum (w_i - o_i) = 0`,
//!   `p' - c' = sum w_i A_i (p - c) + sum (w_i - o_i) (M_i c - c')`,
//!   so p' lies within `r max s_i + sum d_i |M_i c - c'|` of c'. Where all vertices have the same
//!   weights the second term is 0.
//!
//! The smaller of the two bounds is used. Both hold for exact skinning. The rounding errors of f32 skinning and of
//! the bounds themselves are derived where the bounds are computed, in `spheres.rs` and `root.rs`, and added to
//! every radius. The bound of a node costs O(joints of the node). Nodes can be evaluated in any order.
//!
//! Kavan and Zara 2005 ("Fast Collision Detection for Skeletally Deformable Models", Computer Graphics Forum 24(3))
//! refit spheres of linear blend skinning by the hull argument; Unterguggenberger, Kerbl, Pernsteiner and Wimmer 2021
//! ("Conservative Meshlet Bounds for Robust Culling of Skinned Meshes", Computer Graphics Forum 40(7)) bound meshlets.

use fearless_simd::Simd;

mod boxes;
mod joint_table;
mod root;
mod spheres;

pub(crate) use boxes::Boxes;
pub(crate) use joint_table::JointTable;
pub(crate) use root::{RootBox, root_box};
pub(crate) use spheres::{Spheres, find_spheres, spheres};

/// Bounds of the children of a node.
#[derive(Clone, Debug)]
pub(crate) enum Bounds {
    /// From the palette.
    Spheres(Spheres),
    /// Fitted to skinned positions.
    Boxes(Boxes),
}

impl Bounds {
    /// Makes the bounds spheres; `write` fills the spheres in place.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn write_spheres(&mut self, write: impl FnOnce(&mut Spheres)) {
        if let Self::Boxes(_) = self {
            *self = Self::Spheres(Spheres::ZERO);
        }
        if let Self::Spheres(spheres) = self {
            write(spheres);
        }
    }

    /// Spheres that hold everything that these bounds hold.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn spheres<S: Simd>(&self, simd: S) -> Spheres {
        match self {
            Self::Spheres(spheres) => *spheres,
            Self::Boxes(boxes) => boxes.spheres(simd),
        }
    }
}

#[cfg(test)]
impl Bounds {
    /// True if a point lies in the bound of a lane; for a box, also if it lies in the sphere about the box.
    pub(crate) fn holds(&self, lane: usize, p: glam::Vec3) -> bool {
        let spheres =
            fearless_simd::dispatch!(fearless_simd::Level::new(), simd => self.spheres(simd));
        let in_box = match self {
            Self::Spheres(_) => true,
            Self::Boxes(boxes) => (0..3)
                .all(|axis| boxes.low[axis][lane] <= p[axis] && p[axis] <= boxes.high[axis][lane]),
        };
        in_box && spheres.sphere(lane).contains(p)
    }

    /// True if the bound of a lane is empty.
    pub(crate) fn is_empty(&self, lane: usize) -> bool {
        match self {
            Self::Spheres(spheres) => spheres.radius[lane] < 0.0,
            Self::Boxes(boxes) => boxes.low[0][lane] > crate::geometry::MAX_COORDINATE as f32,
        }
    }
}

impl Default for Bounds {
    fn default() -> Self {
        Self::Spheres(Spheres::ZERO)
    }
}

#[cfg(test)]
pub(crate) mod tests;
