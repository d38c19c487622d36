use glam::Vec3;

use clamber_surface::geometry::Sphere;

use super::BoundingCapsule;

/// The bounding volume of a part: a sphere or a capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundingVolume {
    /// A ball.
    Sphere(Sphere),
    /// A capsule.
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

    /// Volume, in cubic units of its space.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Sphere(sphere) => sphere.volume(),
            Self::Capsule(capsule) => capsule.volume(),
        }
    }
}
