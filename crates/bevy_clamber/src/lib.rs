#![doc = include_str!("../README.md")]

mod anchor;
mod collider;
mod plugins;
pub mod prelude;
mod query;
mod surface;

pub use anchor::{AnchorLost, SurfaceAnchor, SurfaceAnchorPlugin};
pub use collider::{ColliderError, ColliderStatus, ColliderTag, SkinnedCollider};
pub use plugins::{ClamberPlugins, ClamberSystems};
pub use query::{SurfaceFilter, SurfaceQuery, WorldHit, WorldSweepHit};
pub use surface::{PoseError, PoseTiming, PosedSurface, SurfacePlugin};

pub use clamber_surface as core;
