#![doc = include_str!("../README.md")]

mod attachment;
#[cfg(feature = "rapier")]
mod debris;
mod obstacle;
#[cfg(feature = "rapier")]
mod rapier;
mod rigid_pose;
#[cfg(feature = "parry")]
pub mod shapes;
mod surface;

pub use attachment::{Attachment, Continuity, Followed};
/// The shape that obstacles are queried with.
pub use clamber_surface::geometry::WorldCapsule;
/// What a contact's material is made of.
pub use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
/// Whether an obstacle moves while something is cast at it.
pub use clamber_surface::surface::TargetMotion;
#[cfg(feature = "rapier")]
pub use debris::{Debris, DebrisConfig, DebrisError, DebrisReport};
/// The crate whose vectors and quaternions are used here.
pub use glam;
pub use obstacle::{Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact};
/// The parry whose shapes [`shapes`] speaks of.
#[cfg(feature = "parry")]
pub use parry3d;
#[cfg(feature = "rapier")]
pub use rapier::{BodyPoses, RapierTerrain, apply_push};
/// The rapier that [`RapierTerrain`] speaks to.
#[cfg(feature = "rapier")]
pub use rapier3d;
pub use rigid_pose::RigidPose;
