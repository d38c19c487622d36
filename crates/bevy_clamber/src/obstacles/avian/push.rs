//! Pushing avian's bodies.

use avian3d::dynamics::rigid_body::RigidBodyQueryReadOnly;
use avian3d::prelude::{ColliderOf, Forces, WriteRigidBodyForces};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use clamber_world::{MaterialPoint, RigidPose};
use glam::DVec3;

use super::moving::MovingColliders;

/// Reads masses.
#[derive(SystemParam)]
pub(super) struct Masses<'w, 's> {
    colliders: Query<'w, 's, &'static ColliderOf>,
    bodies: Query<'w, 's, RigidBodyQueryReadOnly>,
}

impl Masses<'_, '_> {
    /// The speed along a unit direction that an impulse of 1 N s along it gives to a point of a collider; 0 if its body
    /// is not dynamic. `place` is the point in avian's space.
    pub(super) fn response(&self, collider: Entity, place: DVec3, direction: DVec3) -> f64 {
        let body = self.colliders.get(collider).ok();
        let Some(body) = body.and_then(|of| self.bodies.get(of.body).ok()) else {
            return 0.0;
        };
        let along = direction.as_vec3();
        let slide = (body.effective_inverse_mass() * along).dot(along);
        let pose = RigidPose::new(body.rotation.0, body.position.0);
        let center = pose.transform(body.center_of_mass.0.as_dvec3());
        let torque = (place - center).cross(direction).as_vec3();
        let spin = body.effective_global_angular_inertia().inverse() * torque;
        let response = f64::from(slide + torque.dot(spin));
        if response.is_finite() { response } else { 0.0 }
    }
}

/// Applies the impulses of climbers to avian's bodies.
#[derive(SystemParam)]
pub(crate) struct AvianPushes<'w, 's> {
    colliders: Query<'w, 's, &'static ColliderOf>,
    bodies: Query<'w, 's, Forces>,
    moving: Res<'w, MovingColliders>,
}

impl AvianPushes<'_, '_> {
    /// Applies an impulse, newton seconds, to a point of a collider.
    pub(crate) fn push(&mut self, point: &MaterialPoint, impulse: DVec3) {
        let Some(collider) = Entity::try_from_bits(point.key) else {
            return;
        };
        let Some(pose) = self.moving.pose(collider) else {
            return;
        };
        let body = self.colliders.get(collider).ok();
        let Some(mut body) = body.and_then(|of| self.bodies.get_mut(of.body).ok()) else {
            return;
        };
        let place = pose
            .transform(DVec3::from_array(point.coordinates))
            .as_vec3();
        let impulse = impulse.as_vec3();
        if place.is_finite() && impulse.is_finite() {
            body.apply_linear_impulse_at_point(impulse, place);
        }
    }
}
