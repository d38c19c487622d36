//! Terrain and bodies of physics engines, as obstacles for climbers.

#[cfg(feature = "avian")]
mod avian;
#[cfg(feature = "rapier")]
mod rapier;

#[cfg(feature = "avian")]
pub use avian::{AvianObstacles, AvianObstaclesPlugin, AvianTerrain};
#[cfg(feature = "rapier")]
pub use rapier::{RapierObstacles, RapierObstaclesPlugin};
