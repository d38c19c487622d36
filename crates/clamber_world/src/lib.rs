#![doc = include_str!("../README.md")]

mod obstacle;
#[cfg(feature = "rapier")]
mod rapier;
mod surface;

pub use obstacle::{Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion};
#[cfg(feature = "rapier")]
pub use rapier::{BodyPoses, RapierTerrain};
/// The rapier that [`RapierTerrain`] speaks to.
#[cfg(feature = "rapier")]
pub use rapier3d;
