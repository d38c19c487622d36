#![doc = include_str!("../README.md")]

mod attachment;
#[cfg(feature = "rapier")]
mod debris;
mod half_space;
mod obstacle;
mod others;
mod proxy;
#[cfg(feature = "rapier")]
mod rapier;
mod rigid_pose;
#[cfg(feature = "parry")]
pub mod shapes;
mod surface;
#[cfg(test)]
mod testing;
mod triangle_terrain;

pub use attachment::{Attachment, Continuity, FollowResult};
/// A hash for comparing runs.
pub use clamber_surface::Fingerprint;
/// The shape that obstacles are queried with.
pub use clamber_surface::geometry::WorldCapsule;
/// The material tag of a contact.
pub use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
/// Whether an obstacle moves during a cast.
pub use clamber_surface::surface::TargetMotion;
/// Where a material point was and is.
pub use clamber_surface::surface::WorldPath;
#[cfg(feature = "rapier")]
pub use debris::{Debris, DebrisConfig, DebrisError, DebrisReport, DebrisSnapshot};
/// The version of glam that this crate's API uses.
pub use glam;
pub use half_space::HalfSpace;
pub use obstacle::{
    CharacterBody, Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact,
};
pub use others::{Others, OthersError};
/// The version of parry that [`shapes`] uses.
#[cfg(feature = "parry")]
pub use parry3d;
pub use proxy::{ProxyBody, ProxyImpact, ProxyMeeting, ProxyShare, ProxyTouch};
#[cfg(feature = "rapier")]
pub use rapier::{BodyPoses, ClimberProxy, ProxyImpulse, RapierTerrain, apply_push};
/// The version of rapier that [`RapierTerrain`] uses.
#[cfg(feature = "rapier")]
pub use rapier3d;
pub use rigid_pose::RigidPose;
pub use triangle_terrain::{TerrainError, TriangleTerrain};
