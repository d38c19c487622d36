//! Terrain and bodies of other engines, for whoever climbs.

#[cfg(feature = "avian")]
mod avian;
#[cfg(feature = "rapier")]
mod rapier;

#[cfg(feature = "avian")]
pub use avian::{AvianObstacles, AvianObstaclesPlugin, AvianTerrain};
#[cfg(feature = "rapier")]
pub use rapier::{RapierObstacles, RapierObstaclesPlugin};
