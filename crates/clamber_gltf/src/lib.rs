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
mod model;
mod options;
mod prune;
mod readings;
mod scale;
mod skeleton;
mod transforms;
mod tree;
mod uri;
mod vertices;
mod visual;
mod warning;
mod weak_point;

pub use clamber_surface::rig::WeakPoint;
pub use error::{GltfError, GltfErrorKind};
pub use extras::tag_in_extras;
/// The version of glam whose vectors and quaternions this crate uses.
pub use glam;
pub use load::{load, load_all, load_slice, load_slice_with, load_with};
pub use model::{ImportReport, Model};
pub use options::{LoadOptions, Tagger};
pub use visual::{Alpha, Material, VisualMesh, VisualPrimitive};
pub use warning::ImportWarning;
