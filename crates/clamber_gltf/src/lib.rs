#![doc = include_str!("../README.md")]

mod accessor;
mod buffers;
mod clip;
mod collision;
mod contents;
mod document;
mod error;
mod extras;
mod load;
mod looks;
mod members;
mod mesh;
mod skeleton;
mod transforms;
mod tree;
mod vertices;
mod visual;
mod weak_point;

pub use error::{GltfError, GltfErrorKind};
pub use extras::tag_in_extras;
pub use load::{
    ImportReport, LoadOptions, Rig, TagOfMaterial, load, load_all, load_slice, load_with,
};
pub use visual::{Alpha, Material, VisualMesh, VisualPrimitive};
pub use weak_point::WeakPoint;
