//! Bounds of parts in any pose, from the palette alone, in f64: spheres and capsules, by hull and by weight interval.
//!
//! What the library itself uses are spheres, eight at a time in f32 (`SkinnedSurface::in_model().part_spheres()`); these
//! are what benches compare and pictures show. With the words of `clamber_surface`'s bounds, a capsule: at rest
//! `p = s + q` with s on the segment from a to b and `|q| <= r`. Put s for c in the weight interval:
//! `p' = s' + sum w_i A_i q + sum (w_i - o_i) (M_i s - s')` with `s' = sum o_i M_i s`, which runs along the segment from a'
//! to b' as s runs from a to b. `sum d_i |M_i s - s'|` is a sum of lengths of affine functions of s, hence convex along
//! the segment, and largest at one of its ends: p' lies in the capsule about a'b' of radius
//! `r max s_i + max over the two ends e of sum d_i |M_i e - e'|`. By the hull's argument it also lies in the one of radius
//! `max_i (s_i r + max over the two ends e of |M_i e - e'|)`; the smaller radius counts.

mod capsule;
mod joint_maps;
mod node;
mod volume;

pub use capsule::BoundingCapsule;
pub use joint_maps::JointMaps;
pub use node::NodeBounds;
pub use volume::BoundingVolume;

use clamber_surface::mesh::{ColliderMesh, PartId};

/// Bounds of the parts of a mesh under any palette. Made once a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct PartBounds {
    parts: Vec<Option<NodeBounds>>,
}

impl PartBounds {
    /// Reads the rest data of every part.
    pub fn new(mesh: &ColliderMesh) -> Self {
        let parts = mesh.parts().iter();
        Self {
            parts: parts
                .map(|part| NodeBounds::new(mesh, &part.vertices))
                .collect(),
        }
    }

    /// How many parts there are, those without triangles included.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The rest data of a part; `None` if it does not exist or has no triangles left.
    pub fn node(&self, part: PartId) -> Option<&NodeBounds> {
        self.parts.get(part.index())?.as_ref()
    }
}

/// The smallest f32 that is not below `x`.
fn round_up_to_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        nearest.next_up()
    } else {
        nearest
    }
}
