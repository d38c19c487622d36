//! Off-screen pictures of creatures, with what the collider knows drawn over them.
//!
//! A [`Renderer`] draws a [`Frame`] into an [`Image`], without a window: creatures skinned on the GPU by
//! the palette that poses their colliders, ground, rocks and climbers as plain meshes, a sun with shadow,
//! sky and fog; and over them lines and triangles of an [`Overlay`]: joints, bounds, clusters, contacts,
//! anchors. It runs on a GPU or on Mesa's software Vulkan.
//!
//! Positions are f64 in the world; what the GPU gets is relative to the camera, so pictures 100 km from
//! the origin are as sharp as those at it. Per frame it gets palettes, one matrix a mesh and the overlay:
//! nothing for any vertex.

mod camera;
mod error;
mod frame;
mod gpu;
mod image;
mod mesh;
mod overlay;
mod pipelines;
mod renderer;
mod skinning;
mod target;

pub use camera::Camera;
pub use error::RenderError;
pub use frame::{Drawn, Frame, Light};
pub use gpu::Gpu;
pub use image::{Gif, Image};
pub use mesh::{Look, MeshId, MeshSource, SkinSource};
pub use overlay::{Color, Overlay};
pub use renderer::Renderer;
