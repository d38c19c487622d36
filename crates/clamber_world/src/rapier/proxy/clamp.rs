//! Bodies that entered the climber during a step.

use rapier3d::dynamics::{RigidBody, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::math::Pose;
use rapier3d::parry::shape::Shape;

use super::{ClimberProxy, is_solid};
use crate::RigidPose;
use crate::rapier::BodyPoses;
use crate::rapier::terrain::pose_of;

impl ClimberProxy {
    /// Puts each body that entered the climber by its own motion back to where it first touched the climber.
    pub(super) fn clamp(
        &mut self,
        before: &BodyPoses,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        dt: f64,
    ) {
        let mut clamped = std::mem::take(&mut self.clamped);
        clamped.clear();
        for (handle, from, body) in before.moved_dynamic(bodies) {
            if self.is_apart(handle) {
                continue;
            }
            let poses = [&pose_of(&from), &pose_of(body.position())];
            let stopped = self
                .body
                .stop(self.origin, poses, solids(body, colliders), dt);
            clamped.extend(stopped.map(|pose| {
                let (rotation, place) = (pose.rotation.as_quat(), pose.translation.as_vec3());
                (handle, Pose::from_parts(place, rotation))
            }));
        }
        for (handle, pose) in &clamped {
            if let Some(body) = bodies.get_mut(*handle) {
                body.set_position(*pose, true);
            }
        }
        if !clamped.is_empty() {
            // Queries of this tick see colliders, which rapier would move with the next step.
            bodies.propagate_modified_body_positions_to_colliders(colliders);
        }
        self.clamped = clamped;
    }
}

/// The shapes of a body's solid colliders, with their poses on the body.
fn solids<'a>(
    body: &'a RigidBody,
    colliders: &'a ColliderSet,
) -> impl Iterator<Item = (&'a dyn Shape, RigidPose)> + Clone {
    let handles = body.colliders().iter();
    handles.filter_map(|handle| {
        let collider = colliders
            .get(*handle)
            .filter(|collider| is_solid(collider))?;
        let on_body = pose_of(collider.position_wrt_parent()?);
        Some((collider.shape(), on_body))
    })
}
