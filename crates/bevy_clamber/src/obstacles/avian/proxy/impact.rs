use avian3d::prelude::ContactPair;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use clamber_world::{ProxyImpact, RigidPose};
use glam::DVec3;

/// A body's state before its velocity is solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded {
    pub(super) body: Entity,
    pub(super) pose: RigidPose,
    pub(super) linear: Vec3,
    pub(super) angular: Vec3,
    /// The velocity that gravity and forces add to it in the step.
    pub(super) gained: Vec3,
    /// The body's center of mass, in avian's space.
    pub(super) center: DVec3,
}

impl Recorded {
    /// Velocity of a point before the step.
    pub(super) fn velocity_at(&self, point: DVec3) -> DVec3 {
        self.linear.as_dvec3() + self.angular.as_dvec3().cross(point - self.center)
    }

    pub(super) fn find(recorded: &[Self], body: Entity) -> Option<&Self> {
        let index = recorded.binary_search_by_key(&body, |recorded| recorded.body);
        recorded.get(index.ok()?)
    }
}

/// The contacts of one body with a climber.
pub(super) type Impact = ProxyImpact<Entity, Entity>;

/// The contacts of a pair of colliders, of which one is a climber's proxy; `None` if they do not touch. In avian's
/// space.
pub(super) fn impact_of(pair: &ContactPair, stand_in: Entity) -> Option<Impact> {
    let (body, collider) = other(pair, stand_in)?;
    let is_first = pair.collider1 == stand_in;
    let mut impact = Impact::new(body, collider);
    for manifold in &pair.manifolds {
        let normal = manifold.normal.as_dvec3();
        let normal = if is_first { normal } else { -normal };
        for contact in &manifold.points {
            let (weight, point) = (contact.normal_impulse.into(), contact.point.as_dvec3());
            impact.add(weight, point, normal, manifold.friction.into());
        }
    }
    impact.touches().then_some(impact)
}

/// The body and the collider of a pair that do not stand for a climber.
pub(super) fn other(pair: &ContactPair, stand_in: Entity) -> Option<(Entity, Entity)> {
    if pair.collider1 == stand_in {
        Some((pair.body2?, pair.collider2))
    } else {
        Some((pair.body1?, pair.collider1))
    }
}
