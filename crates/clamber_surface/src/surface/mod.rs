//! The posed surface: one instance of a collider mesh, its queries, and points that stick to it.
//!
//! [`SkinnedSurface::advance`] skins nothing. A query ([`SkinnedSurface::in_model`]) descends a hierarchy of spheres that
//! follow from the palette alone, and skins the clusters of vertices that it reaches, once a tick; its answer is
//! that of skinning everything and testing every triangle, bit for bit.
//!
//! Casts ([`ModelSpace::cast_capsule`]) meet skin that stands still, or on its way from the previous pose to
//! the current one, and promise what they report: never late, never farther than a tolerance.

#[cfg(test)]
pub(crate) mod agreement;
mod anchor;
mod deformation;
mod diagnostics;
mod edit;
mod error;
mod extent;
mod motion;
mod patch;
mod skinned;
pub(crate) mod winding;
mod world;

pub use crate::query::{
    CapsuleHit, CastOptions, ModelSpace, MovingTriangle, SurfaceHit, SweepHit, TargetMotion,
};
pub use anchor::{Anchor, SurfacePoint};
pub use diagnostics::{ClusterState, Diagnostics};
pub use edit::SurfaceEdit;
pub use error::SurfaceError;
pub use motion::Motion;
pub use patch::{Patch, PatchChange};
pub use skinned::SkinnedSurface;
pub use world::{WorldHit, WorldMotion, WorldSpace, WorldSweepHit};
