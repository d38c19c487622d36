use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

use crate::{Camera, Overlay, RenderMeshId};

/// A picture to draw with [`Renderer::draw`](crate::Renderer::draw): the viewpoint, the light, the meshes, and the
/// overlay.
#[derive(Clone, Debug)]
pub struct Frame<'a> {
    /// The viewpoint.
    pub camera: Camera,
    /// The sun, its shadows, and fog.
    pub light: Light,
    /// The meshes to draw. A mesh may be drawn several times.
    pub drawn: Vec<Drawn<'a>>,
    /// The lines and triangles to draw over the meshes.
    pub overlay: Overlay,
}

/// An instance of a mesh in a picture.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// The mesh, from [`Renderer::add_mesh`](crate::Renderer::add_mesh).
    pub mesh: RenderMeshId,
    /// Placement of the mesh in the world.
    pub world_from_model: Similarity,
    /// The palette that poses it; `None` draws it at rest. A mesh without a skin must have `None`.
    pub palette: Option<&'a Palette>,
}

/// The sun, its shadows, and fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Direction towards the sun, in world space; of any length but 0.
    pub to_sun: Vec3,
    /// Share of the light that a metre of air absorbs, at least 0; about 0.002 on a hazy day.
    pub fog: f32,
    /// Centre of the region with shadows, in world space.
    pub shadow_center: DVec3,
    /// Radius of the region with shadows, metres; greater than 0.
    pub shadow_radius: f64,
}

impl Light {
    /// A low sun and thin fog, with shadows within `radius` metres of `center`.
    pub fn over(center: DVec3, radius: f64) -> Self {
        Self {
            to_sun: Vec3::new(0.62, 0.52, 0.35),
            fog: 0.0013,
            shadow_center: center,
            shadow_radius: radius,
        }
    }
}
