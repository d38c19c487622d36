//! A light obstacle that another object holds.

use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule,
};
use glam::DVec3;

/// An obstacle that responds to impulses like a body with a mass, kg, and does not give way.
pub(crate) struct Held<T>(pub(crate) T, pub(crate) f64);

impl<T: Obstacle> Obstacle for Held<T> {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.0.overlap_capsule(capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        self.0.cast_capsule(capsule, displacements, target)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        self.0.motion(point, dt)
    }

    fn inverse_effective_mass(&self, _: &MaterialPoint, _: DVec3) -> f64 {
        1.0 / self.1
    }
}
