#![doc = include_str!("../README.md")]

mod accessor;
mod buffers;
mod clip;
mod document;
mod error;
mod load;
mod mesh;
mod skeleton;
mod tag;

pub use error::GltfError;
pub use load::{ImportReport, LoadOptions, Rig, TagOfMaterial, load, load_slice, load_with};
