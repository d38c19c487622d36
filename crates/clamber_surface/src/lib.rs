#![doc = include_str!("../README.md")]

pub mod geometry;
pub mod mesh;
#[cfg(feature = "parry")]
pub mod parry;
pub mod rig;
mod simd;
pub mod skin;
pub mod surface;

pub use simd::SimdLevel;

#[cfg(test)]
mod testing;
