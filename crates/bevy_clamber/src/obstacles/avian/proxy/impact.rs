use avian3d::prelude::ContactPair;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use clamber_world::RigidPose;
use glam::DVec3;

/// What is recorded of a body before its velocity is solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded {
    pub(super) body: Entity,
    pub(super) pose: RigidPose,
    pub(super) linear: Vec3,
    pub(super) angular: Vec3,
    /// What gravity and forces add to its velocity in the step.
    pub(super) gained: Vec3,
    /// Its center of mass, in avian's space.
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
#[derive(Clone, Copy, Debug)]
pub(super) struct Impact {
    pub(super) body: Entity,
    /// The collider with the strongest of them.
    pub(super) collider: Entity,
    /// Avian's impulse there.
    strongest: f64,
    /// Sums over the contacts, weighed by their impulses: the impulses, the points in avian's space, the normals from
    /// the climber to the body, and the coefficients of friction.
    pub(super) weight: f64,
    pub(super) point: DVec3,
    pub(super) normal: DVec3,
    pub(super) friction: f64,
}

impl Impact {
    /// The contacts of a pair of which one collider stands for a climber; `None` if they do not touch.
    pub(super) fn of(pair: &ContactPair, stand_in: Entity) -> Option<Self> {
        let (body, collider) = other(pair, stand_in)?;
        let is_first = pair.collider1 == stand_in;
        let mut impact = Self {
            body,
            collider,
            strongest: 0.0,
            weight: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::ZERO,
            friction: 0.0,
        };
        for manifold in &pair.manifolds {
            let normal = manifold.normal.as_dvec3();
            let normal = if is_first { normal } else { -normal };
            for contact in &manifold.points {
                let weight = f64::from(contact.normal_impulse);
                impact.weight += weight;
                impact.point += contact.point.as_dvec3() * weight;
                impact.normal += normal * weight;
                impact.friction += f64::from(manifold.friction) * weight;
            }
        }
        impact.strongest = impact.weight;
        (impact.weight > 0.0).then_some(impact)
    }

    /// Of the impacts of several colliders of a body, one.
    pub(super) fn merge(impacts: &mut Vec<Self>) {
        impacts.sort_unstable_by_key(|impact| (impact.body, impact.collider));
        impacts.dedup_by(|next, first| {
            let is_same = next.body == first.body;
            if is_same {
                first.weight += next.weight;
                first.point += next.point;
                first.normal += next.normal;
                first.friction += next.friction;
                if next.strongest > first.strongest {
                    (first.collider, first.strongest) = (next.collider, next.strongest);
                }
            }
            is_same
        });
    }
}

/// The body and the collider of a pair that do not stand for a climber.
pub(super) fn other(pair: &ContactPair, stand_in: Entity) -> Option<(Entity, Entity)> {
    if pair.collider1 == stand_in {
        Some((pair.body2?, pair.collider2))
    } else {
        Some((pair.body1?, pair.collider1))
    }
}
