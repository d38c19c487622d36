//! The posed surface: one instance of a collider mesh, its queries, and points that stick to it.
//!
//! [`SkinnedSurface::advance`] skins nothing. A query descends a hierarchy of spheres that follow from
//! the palette alone, and skins the clusters of vertices that it reaches, once a tick; its answer is
//! that of skinning everything and testing every triangle, bit for bit: [`BruteForce`].
//!
//! Casts and sweeps ([`SkinnedSurface::sweep_sphere`]) meet the skin on its way from the previous pose to
//! the current one, and promise what they report: never late, never farther than a tolerance.
//!
//! [`PartBounds`] bounds parts in any pose without skinning a vertex.

#[cfg(test)]
mod agreement;
mod anchor;
mod bounds;
mod brute_force;
mod deformation;
mod diagnostics;
mod edit;
mod error;
mod motion;
mod patch;
mod pose;
mod query;
mod refit;
mod skinned;
mod winding;

pub use anchor::Anchor;
pub use bounds::{JointMaps, NodeBounds, PartBounds, WeightInterval};
pub(crate) use bounds::{RootBalls, inflation};
pub use brute_force::BruteForce;
pub use diagnostics::{ClusterState, Diagnostics};
pub use edit::SurfaceEdit;
pub use error::SurfaceError;
pub use motion::Motion;
pub use patch::{Patch, PatchChange};
pub use query::{CapsuleHit, MovingTriangle, SurfaceHit, SweepHit};
pub use refit::refit_part_spheres;
pub use skinned::SkinnedSurface;
pub use winding::winding_number;

/// How near a sweep comes before it counts as a contact, in metres, at human scale: a tenth of a
/// millimetre. Larger takes fewer steps where something is grazed; smaller gains nothing that a
/// character would notice.
pub const TOLERANCE: f32 = 1e-4;
