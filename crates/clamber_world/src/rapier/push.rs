use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{Collider, ColliderSet};

use super::RapierTerrain;
use crate::MaterialPoint;

/// Applies an impulse, in N s, at a point of a [`RapierTerrain`](crate::RapierTerrain) to the body there, and wakes it
/// up.
///
/// A climber's step returns its pushes; apply them before rapier's next step. Does nothing if the body is not dynamic
/// or has been removed, or if the impulse is not finite.
///
/// ```
/// use clamber_world::{BodyPoses, Obstacle, RapierTerrain, apply_push};
/// use glam::DVec3;
/// use rapier3d::prelude::*;
///
/// let mut world = PhysicsWorld::default();
/// world.gravity = Vector::ZERO;
/// let (crate_body, _) = world.insert(
///     RigidBodyBuilder::dynamic(),
///     ColliderBuilder::cuboid(0.5, 0.5, 0.5).mass(20.0),
/// );
/// world.step();
/// let before = BodyPoses::new();
/// let terrain = RapierTerrain::of_world(&world, &before);
/// let touched = terrain.closest_point(DVec3::X * 2.0, 3.0).unwrap().material;
/// // 1 N s along X moves 20 kg, hit in the middle, by 0.05 m/s.
/// assert!((terrain.inverse_effective_mass(&touched, DVec3::X) - 0.05).abs() < 1e-6);
/// apply_push(&mut world.bodies, &world.colliders, &touched, DVec3::X * 10.0);
/// assert!((world.bodies[crate_body].linvel().x - 0.5).abs() < 1e-6);
/// ```
pub fn apply_push(
    bodies: &mut RigidBodySet,
    colliders: &ColliderSet,
    point: &MaterialPoint,
    impulse: DVec3,
) {
    let Some((handle, collider)) = pushed(colliders, point) else {
        return;
    };
    let place = place(collider, point);
    let impulse = impulse.as_vec3();
    if let Some(body) = bodies.get_mut(handle)
        && impulse.is_finite()
        && place.is_finite()
    {
        body.apply_impulse_at_point(impulse, place.as_vec3(), true);
    }
}

/// [`Obstacle::inverse_effective_mass`](crate::Obstacle::inverse_effective_mass) of a rapier world. Joints are ignored:
/// a jointed body responds as if it were free.
pub(super) fn inverse_effective_mass(
    bodies: &RigidBodySet,
    colliders: &ColliderSet,
    point: &MaterialPoint,
    direction: DVec3,
) -> f64 {
    let body = |handle| {
        bodies
            .get(handle)
            .filter(|body| body.is_dynamic() && body.is_enabled())
    };
    let response = pushed(colliders, point).and_then(|(handle, collider)| {
        Some(response(body(handle)?, place(collider, point), direction))
    });
    response
        .filter(|response| response.is_finite())
        .unwrap_or(0.0)
}

fn pushed<'a>(
    colliders: &'a ColliderSet,
    point: &MaterialPoint,
) -> Option<(RigidBodyHandle, &'a Collider)> {
    let collider = colliders.get(RapierTerrain::collider_of(point))?;
    Some((collider.parent()?, collider))
}

/// Position of a point in rapier's space.
fn place(collider: &Collider, point: &MaterialPoint) -> DVec3 {
    super::terrain::pose_of(collider.position()).transform(DVec3::from_array(point.coordinates))
}

/// Change of the point's speed along a unit direction for an impulse of 1 N s along it.
fn response(body: &RigidBody, place: DVec3, direction: DVec3) -> f64 {
    let (slide, torque, spin) = answer(body, place, direction);
    slide.dot(direction) + torque.dot(spin)
}

/// Change of the point's velocity for an impulse there.
pub(super) fn point_response(body: &RigidBody, place: DVec3, impulse: DVec3) -> DVec3 {
    let (slide, _, spin) = answer(body, place, impulse);
    slide + spin.cross(place - body.mass_properties().world_com.as_dvec3())
}

/// The effects of an impulse at a point of a body: the change of linear velocity, the torque impulse, and the change of
/// angular velocity.
fn answer(body: &RigidBody, place: DVec3, impulse: DVec3) -> (DVec3, DVec3, DVec3) {
    let mass = body.mass_properties();
    let inertia = mass.effective_world_inv_inertia;
    let entry = f64::from;
    let torque = (place - mass.world_com.as_dvec3()).cross(impulse);
    let spin = DVec3::new(
        DVec3::new(entry(inertia.m11), entry(inertia.m12), entry(inertia.m13)).dot(torque),
        DVec3::new(entry(inertia.m12), entry(inertia.m22), entry(inertia.m23)).dot(torque),
        DVec3::new(entry(inertia.m13), entry(inertia.m23), entry(inertia.m33)).dot(torque),
    );
    (mass.effective_inv_mass.as_dvec3() * impulse, torque, spin)
}

#[cfg(test)]
mod tests;
