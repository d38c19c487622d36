//! The posed surface: one instance of a collider mesh, its queries, and points that stick to it.
//!
//! This is the eager form: [`SkinnedSurface::advance`] skins every vertex once and refits a sphere
//! per part; queries test the triangles of the parts whose sphere they meet. Each query has a
//! brute-force twin over all triangles, `*_reference`, with which it agrees bit for bit.
//!
//! [`PartBounds`] bounds parts in any pose without skinning a vertex.

mod anchor;
mod bounds;
mod deformation;
mod edit;
mod error;
mod motion;
mod query;
mod refit;
mod skinned;

pub use anchor::Anchor;
pub use bounds::{JointMaps, NodeBounds, PartBounds, WeightInterval};
pub use error::SurfaceError;
pub use motion::Motion;
pub use query::SurfaceHit;
pub use refit::refit_part_spheres;
pub use skinned::SkinnedSurface;
