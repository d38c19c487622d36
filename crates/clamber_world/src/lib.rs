#![doc = include_str!("../README.md")]

mod attachment;
#[cfg(feature = "rapier")]
mod debris;
mod obstacle;
#[cfg(feature = "rapier")]
mod rapier;
#[cfg(feature = "parry")]
pub mod shapes;
mod surface;

pub use attachment::{Attachment, Continuity, Followed};
/// What a contact's material is made of.
pub use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
#[cfg(feature = "rapier")]
pub use debris::{Debris, DebrisConfig, DebrisError, DebrisReport};
pub use obstacle::{
    Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, WorldCapsule,
};
#[cfg(feature = "rapier")]
pub use rapier::{BodyPoses, RapierTerrain, apply_push};
/// The rapier that [`RapierTerrain`] speaks to.
#[cfg(feature = "rapier")]
pub use rapier3d;
