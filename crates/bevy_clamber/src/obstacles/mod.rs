//! Terrain and bodies of physics engines, as obstacles for climbers.

#[cfg(feature = "avian")]
mod avian;
#[cfg(feature = "rapier")]
mod debris;
#[cfg(feature = "rapier")]
mod proxy;
#[cfg(feature = "rapier")]
mod rapier;

#[cfg(feature = "avian")]
pub(crate) use avian::AvianPushes;
#[cfg(feature = "avian")]
pub use avian::{AvianObstacles, AvianObstaclesPlugin, AvianProxy, AvianProxyPlugin, AvianTerrain};
#[cfg(feature = "rapier")]
pub use debris::{Debris, DebrisBodies, DebrisHooks, DebrisPlugin};
#[cfg(feature = "rapier")]
pub(crate) use proxy::RapierProxies;
#[cfg(feature = "rapier")]
pub use proxy::{RapierProxy, RapierProxyPlugin};
#[cfg(feature = "rapier")]
pub(crate) use rapier::RapierPushes;
#[cfg(feature = "rapier")]
pub use rapier::{RapierObstacles, RapierObstaclesPlugin};
