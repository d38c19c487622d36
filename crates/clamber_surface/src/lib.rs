#![doc = include_str!("../README.md")]

mod bounds;
mod fingerprint;
pub mod geometry;
#[doc(hidden)]
pub mod measure;
pub mod mesh;
mod pose;
mod query;
pub mod rig;
mod simd;
pub mod skin;
pub mod surface;

#[doc(hidden)]
pub use fingerprint::Fingerprint;
/// The version of `glam` that provides the vector and quaternion types of this crate.
pub use glam;
pub use simd::SimdLevel;

#[cfg(test)]
mod testing;
