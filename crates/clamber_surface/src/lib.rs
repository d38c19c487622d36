#![doc = include_str!("../README.md")]

mod bounds;
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

/// The version of `glam` that provides the vector and quaternion types of this crate.
pub use glam;
#[doc(hidden)]
pub use simd::SimdLevel;

#[cfg(test)]
mod testing;
