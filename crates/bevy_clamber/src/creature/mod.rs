//! Creatures that `clamber_gltf` loads, as entities: an app needs no `bevy_gltf` for them.

mod assets;
mod mesh;
mod player;

pub use assets::{RigAssets, RigJoints, RigMaterial, SpawnedRig, TooManyJoints};
pub use player::{RigPlayer, RigPlayerPlugin};
