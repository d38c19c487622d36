//! Spawns creatures that `clamber_gltf` loads and plays their clips, without `bevy_gltf`.

mod assets;
mod mesh;
mod player;

pub(crate) use assets::transform;
pub use assets::{RigAssets, RigJoints, RigMaterial, SpawnedRig, TooManyJoints};
#[cfg(feature = "colossus")]
pub(crate) use player::play;
pub use player::{RigMarkerPassed, RigPlayer, RigPlayerPlugin};
