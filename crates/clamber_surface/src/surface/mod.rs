//! The posed surface: one instance of a collider mesh, its queries, and points that move with it.
//!
//! [`SkinnedSurface::advance`] skins nothing, unless queries reached nearly all clusters in the last tick. A query
//! ([`SkinnedSurface::in_model`]) descends a hierarchy of spheres that follow from the palette alone, and skins the
//! clusters of vertices that it reaches, each once a tick. Its result has the bits of skinning everything and testing
//! every triangle.
//!
//! Casts ([`ModelSpace::cast_capsule`]) are made at skin that stands still, or at skin that moves from the previous
//! pose to the current one. A contact is never reported later than the first touch, nor farther away than a tolerance
//! unless it is flagged undecided.

#[cfg(test)]
pub(crate) mod agreement;
mod anchor;
mod deformation;
mod diagnostics;
mod edit;
mod error;
mod extent;
mod fingerprint;
mod motion;
mod patch;
mod skinned;
pub(crate) mod winding;
mod world;

pub use crate::query::{
    CastOptions, ModelSpace, MovingTriangle, SurfaceHit, SweepHit, TargetMotion,
};
pub use anchor::{Anchor, SurfacePoint};
pub use diagnostics::{ClusterState, Diagnostics};
pub use edit::SurfaceEdit;
pub use error::SurfaceError;
pub use fingerprint::{creature_fingerprint, matrices_fingerprint, palette_fingerprint};
pub use motion::{Motion, PointPath};
pub use patch::{Patch, PatchChange};
pub use skinned::SkinnedSurface;
pub use world::{WorldMotion, WorldPath, WorldSpace};
