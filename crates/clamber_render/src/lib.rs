#![doc = include_str!("../README.md")]
#![allow(
    clippy::disallowed_types,
    reason = "pictures need not have the same bits everywhere"
)]

// `failures` includes `tests/all/common`, which names this crate `clamber_render`.
#[cfg(test)]
extern crate self as clamber_render;

mod animation;
mod camera;
mod error;
#[cfg(test)]
mod failures;
mod frame;
mod gpu;
mod image;
mod mesh;
mod overlay;
mod paint;
mod pipelines;
mod renderer;
mod skinning;
mod target;
mod text;
#[cfg(feature = "gltf")]
mod visual;

pub use animation::Gif;
pub use camera::Camera;
pub use error::RenderError;
pub use frame::{Drawn, Frame, Light};
/// The version of glam whose vectors and quaternions this crate uses.
pub use glam;
pub use gpu::Gpu;
pub use image::Image;
pub use mesh::{Look, RenderMesh, RenderMeshId, SkinSource};
pub use overlay::{Color, Overlay};
pub use paint::Paint;
pub use renderer::Renderer;
pub use text::TextSize;
#[cfg(feature = "gltf")]
pub use visual::{VisualSource, visual_meshes};
