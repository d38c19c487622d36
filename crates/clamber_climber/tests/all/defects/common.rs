//! Helpers that several of the tests share.

use clamber_climber::{Climber, ClimberInput, ContactQuery, StepReport, StepRules};
use clamber_world::rapier3d::prelude::{ColliderBuilder, Vector};
use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule,
};
use glam::DVec3;

use crate::scene::{DT, list};
use crate::stage::Shape;

pub(crate) const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Steps a climber by one tick at 60 Hz, in which every contact can be gripped, or none.
pub(crate) fn tick_gripping(
    climber: &mut Climber,
    obstacles: &[&dyn Obstacle],
    input: &ClimberInput,
    can_grip: bool,
) -> StepReport {
    let rule = move |query: &ContactQuery<'_>| query.usual().with_grip(can_grip);
    let rules = StepRules::by(&rule);
    climber
        .step_with(input, &list(obstacles), &rules, DT)
        .unwrap()
}

/// An obstacle that answers queries, but reports motion only while `tells` is true.
pub(crate) struct Mute<'a> {
    pub(crate) inner: &'a dyn Obstacle,
    pub(crate) tells: bool,
}

impl Obstacle for Mute<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.cast_ray(origin, direction, max_distance)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.closest_point(point, max_distance)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.inner.overlap_capsule(capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        self.inner.cast_capsule(capsule, displacements, target)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        self.tells.then(|| self.inner.motion(point, dt))?
    }
}

/// A shape as a triangle mesh collider of rapier.
pub(crate) fn trimesh(shape: &Shape) -> ColliderBuilder {
    let corners: Vec<Vector> = shape.positions.iter().map(|p| p.as_vec3()).collect();
    ColliderBuilder::trimesh(corners, shape.triangles.clone()).unwrap()
}
