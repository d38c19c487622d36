#![doc = include_str!("../README.md")]

pub mod geometry;
pub mod mesh;
pub mod rig;
pub mod skin;
pub mod surface;

#[cfg(test)]
mod testing;
