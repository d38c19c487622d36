//! Bounds of parts in any pose, from the palette alone, in f64: spheres and capsules, by hull and by weight interval.
//!
//! The library itself uses spheres only, eight at a time in f32 (`SkinnedSurface::in_model().part_spheres()`). The
//! bounds here serve benches, which compare them with the library's, and pictures.
//!
//! The spheres are derived in `clamber_surface`'s `bounds` module. The capsule follows with the same symbols. At rest
//! `p = s + q`, with s on the segment from a to b and `|q| <= r`. Replace c by s in the weight interval: `p' = s' + sum
//! w_i A_i q + sum (w_i - o_i) (M_i s - s')` with `s' = sum o_i M_i s`, which runs along the segment from a' to b' as s
//! runs from a to b. `sum d_i |M_i s - s'|` is a sum of lengths of affine functions of s. It is therefore convex along
//! the segment, and largest at one of its ends, so p' lies in the capsule around a'b' of radius `r max s_i + max over
//! the two ends e of sum d_i |M_i e - e'|`. By the hull's argument p' also lies in the capsule around a'b' of radius
//! `max_i (s_i r + max over the two ends e of |M_i e - e'|)`. The smaller radius is used.

mod capsule;
mod joint_maps;
mod node;
mod volume;

pub use capsule::BoundingCapsule;
pub use joint_maps::JointMaps;
pub use node::NodeBounds;
pub use volume::BoundingVolume;

use clamber_surface::mesh::{ColliderMesh, PartId};

/// Bounds of the parts of a mesh under any palette. Built once per mesh.
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

    /// Number of parts, including those without triangles.
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// The bounds of a part; `None` if it does not exist or has no triangles left.
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
