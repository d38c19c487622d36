//! Poses of moving colliders. Avian's own trees and the positions of child colliders date from before the solver moved
//! the bodies: one tick too early for climbers that are carried.

use avian3d::parry::bounding_volume::{Aabb, BoundingVolume};
use avian3d::parry::math::Pose;
use avian3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use avian3d::parry::query::{Ray, RayCast};
use avian3d::prelude::{Collider, ColliderOf, ColliderTransform, Position, RigidBody, Rotation};
use bevy_ecs::prelude::*;
use clamber_world::RigidPose;
use glam::DVec3;

use crate::WorldOrigin;

/// Margin that is added to bounds, metres, so that rounding misses no collider.
const LOOSE: f32 = 1e-3;

/// A collider of a body that is not static.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBody {
    pub(super) entity: Entity,
    pub(super) pose: RigidPose,
    /// The pose before the last step, if it was another.
    pub(super) before: Option<RigidPose>,
    /// Bounds in the current pose.
    pub(super) bounds: Aabb,
    /// Bounds in both poses, and so of all straight lines between them.
    pub(super) swept: Aabb,
}

/// Colliders of bodies that are not static, after the last step and before it, both sorted by entity.
#[derive(Resource, Default)]
pub(super) struct MovingColliders {
    now: Vec<MovingBody>,
    before: Vec<MovingBody>,
    /// The [`WorldOrigin`] at the last step.
    origin: DVec3,
    /// Over the swept bounds of `now`, by index.
    tree: Bvh,
}

impl MovingColliders {
    pub(super) fn iter(&self) -> impl Iterator<Item = &MovingBody> {
        self.now.iter()
    }

    /// The colliders whose swept bounds meet a box.
    pub(super) fn near<'a>(&'a self, bounds: &'a Aabb) -> impl Iterator<Item = &'a MovingBody> {
        let near = self.tree.intersect_aabb(bounds);
        near.filter_map(|index| self.now.get(index as usize))
    }

    /// The colliders whose swept bounds meet a ray, up to a distance.
    pub(super) fn along<'a>(
        &'a self,
        ray: &'a Ray,
        max_distance: f32,
    ) -> impl Iterator<Item = &'a MovingBody> {
        let meets = move |node: &BvhNode| node.aabb().intersects_local_ray(ray, max_distance);
        let met = self.tree.leaves(meets);
        met.filter_map(|index| self.now.get(index as usize))
    }

    /// The current pose of a collider; `None` if it is not a moving one.
    pub(super) fn pose(&self, entity: Entity) -> Option<RigidPose> {
        find(&self.now, entity).map(|moving| moving.pose)
    }

    /// The pose of a collider before the last step; `None` if it has not changed, or the collider is new.
    pub(super) fn previous_pose(&self, entity: Entity) -> Option<RigidPose> {
        find(&self.now, entity)?.before
    }
}

fn find(all: &[MovingBody], entity: Entity) -> Option<&MovingBody> {
    let index = all.binary_search_by_key(&entity, |moving| moving.entity);
    index.ok().map(|index| &all[index])
}

/// Records poses after a step. Bodies that a game moves between two steps have motion, too, since only the poses after
/// steps are compared.
pub(super) fn note(
    mut moving: ResMut<MovingColliders>,
    origin: Res<WorldOrigin>,
    colliders: Query<(Entity, &Collider, &ColliderOf, Option<&ColliderTransform>)>,
    bodies: Query<(&RigidBody, &Position, &Rotation)>,
) {
    let MovingColliders {
        now,
        before,
        origin: old,
        tree,
    } = &mut *moving;
    std::mem::swap(now, before);
    if *old != origin.0 {
        let by = *old - origin.0;
        for moving in before.iter_mut() {
            moving.pose.translation += by;
            moving.bounds = moving.bounds.translated(by.as_vec3());
        }
        *old = origin.0;
    }
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
    let bounds = now.iter().map(|moving| moving.swept).enumerate();
    *tree = Bvh::from_iter(BvhBuildStrategy::Binned, bounds);
}

/// A pose of parry, in f32.
pub(super) fn in_f32(pose: &RigidPose) -> Pose {
    Pose::from_parts(pose.translation.as_vec3(), pose.rotation.as_quat())
}
