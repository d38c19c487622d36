//! Where colliders are that move. Avian's own trees and the positions of child colliders are those from before
//! the solver moved the bodies: too early by a tick for whoever is carried.

use avian3d::parry::bounding_volume::{Aabb, BoundingVolume};
use avian3d::parry::math::Pose;
use avian3d::prelude::{Collider, ColliderOf, ColliderTransform, Position, RigidBody, Rotation};
use bevy_ecs::prelude::*;
use clamber_world::RigidPose;

/// Metres that bounds are too large, so that none is missed by rounding.
const LOOSE: f32 = 1e-3;

/// A collider of a body that is not static.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBody {
    pub(super) entity: Entity,
    pub(super) pose: RigidPose,
    /// A step before, if it was elsewhere.
    pub(super) before: Option<RigidPose>,
    /// Of the pose now.
    pub(super) bounds: Aabb,
    /// Of both poses, and so of all lines between.
    pub(super) swept: Aabb,
}

/// Colliders of bodies that are not static, after the last step and before it; each by ascending entity.
#[derive(Resource, Debug, Default)]
pub(super) struct MovingColliders {
    now: Vec<MovingBody>,
    before: Vec<MovingBody>,
}

impl MovingColliders {
    pub(super) fn iter(&self) -> impl Iterator<Item = &MovingBody> {
        self.now.iter()
    }

    /// Where a collider is; `None` if it does not move.
    pub(super) fn pose(&self, entity: Entity) -> Option<RigidPose> {
        find(&self.now, entity).map(|moving| moving.pose)
    }

    /// Where it was; `None` if it has not moved, or was not there.
    pub(super) fn previous_pose(&self, entity: Entity) -> Option<RigidPose> {
        find(&self.now, entity)?.before
    }
}

fn find(all: &[MovingBody], entity: Entity) -> Option<&MovingBody> {
    let index = all.binary_search_by_key(&entity, |moving| moving.entity);
    index.ok().map(|index| &all[index])
}

/// After a step. What a game moves between two steps is motion, too, as this looks at nothing but where colliders
/// come to be.
pub(super) fn note(
    mut moving: ResMut<MovingColliders>,
    colliders: Query<(Entity, &Collider, &ColliderOf, Option<&ColliderTransform>)>,
    bodies: Query<(&RigidBody, &Position, &Rotation)>,
) {
    let MovingColliders { now, before } = &mut *moving;
    std::mem::swap(now, before);
    now.clear();
    for (entity, collider, of, on_body) in &colliders {
        let Ok((body, position, rotation)) = bodies.get(of.body) else {
            continue;
        };
        if body.is_static() {
            continue;
        }
        let mut pose = RigidPose::new(rotation.0, position.0);
        if let Some(on_body) = on_body.filter(|_| of.body != entity) {
            pose = pose.compose(&RigidPose::new(on_body.rotation, on_body.translation));
        }
        let bounds = collider.shape_scaled().compute_aabb(&in_f32(&pose));
        let bounds = bounds.loosened(LOOSE);
        let earlier = find(before, entity).filter(|earlier| earlier.pose != pose);
        now.push(MovingBody {
            entity,
            pose,
            before: earlier.map(|earlier| earlier.pose),
            bounds,
            swept: earlier.map_or(bounds, |earlier| bounds.merged(&earlier.bounds)),
        });
    }
    now.sort_unstable_by_key(|moving| moving.entity);
}

/// As parry takes it.
pub(super) fn in_f32(pose: &RigidPose) -> Pose {
    Pose::from_parts(pose.translation.as_vec3(), pose.rotation.as_quat())
}
