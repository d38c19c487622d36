use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};

use crate::{Camera, Overlay, RenderMeshId};

/// A picture to be.
#[derive(Clone, Debug)]
pub struct Frame<'a> {
    /// From where.
    pub camera: Camera,
    /// What lights it.
    pub light: Light,
    /// What stands in it.
    pub drawn: Vec<Drawn<'a>>,
    /// What is drawn over it.
    pub overlay: Overlay,
}

/// A mesh in a picture.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// Which one.
    pub mesh: RenderMeshId,
    /// Where it stands.
    pub world_from_model: Similarity,
    /// How it is posed; `None` draws it at rest.
    pub palette: Option<&'a Palette>,
}

/// The sun and the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards the sun.
    pub to_sun: Vec3,
    /// Share of the light that a metre of air takes, about 0.002 on a hazy day.
    pub fog: f32,
    /// The middle of what casts shadows, in the world.
    pub shadow_center: DVec3,
    /// How far shadows reach from there, metres.
    pub shadow_radius: f64,
}

impl Light {
    /// A low sun over what stands within `radius` of `center`.
    pub fn over(center: DVec3, radius: f64) -> Self {
        Self {
            to_sun: Vec3::new(0.62, 0.52, 0.35),
            fog: 0.0013,
            shadow_center: center,
            shadow_radius: radius,
        }
    }
}
