use glam::Vec3;

use clamber_surface::geometry::Sphere;

use super::BoundingCapsule;

/// What bounds a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundingVolume {
    /// A ball.
    Sphere(Sphere),
    /// A segment with a radius.
    Capsule(BoundingCapsule),
}

impl BoundingVolume {
    /// True if `point` lies inside, by f64 arithmetic.
    pub fn contains(&self, point: Vec3) -> bool {
        match self {
            Self::Sphere(sphere) => sphere.contains(point),
            Self::Capsule(capsule) => capsule.contains(point),
        }
    }

    /// In cubic units of its space.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.volume(),
            Self::Capsule(capsule) => capsule.volume(),
        }
    }
}
