#![doc = include_str!("../../../README.md")]

#[cfg(feature = "gltf")]
#[doc(inline)]
pub use clamber_gltf as gltf;
#[doc(inline)]
pub use clamber_surface::{geometry, mesh, rig, skin, surface};
