use avian3d::parry::bounding_volume::{Aabb, BoundingVolume};
use avian3d::parry::query::{Ray, RayCast};
use avian3d::prelude::{Collider, ColliderAabb, SpatialQueryFilter};
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Vec3};
use bevy_shape::Ray3d;
use clamber_surface::mesh::SurfaceTag;
use clamber_world::shapes::{
    FirstContact, SweptBounds, Tick, closest_by_overlap, holds, overlap_shape, sort_contacts,
};
use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, RigidPose, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::DVec3;

use super::AvianObstacles;
use super::moving::{MovingBody, in_f32};

/// How far bounds are searched beyond a ray's end, as a share of its length and, in addition, in metres. Otherwise
/// rounding could miss a collider at the end.
const LOOSE: f32 = 1e-4;

/// An avian world as one obstacle: all its colliders except sensors, as of the last step.
///
/// The terrain only borrows: make it anew each tick. Height fields and triangle meshes are tested per triangle, from
/// both sides. Convex shapes are solid. `RapierTerrain` gives the same answers for the same shapes. Rays are cast by
/// parry: a ray that hits exactly an edge between two triangles may pass through.
///
/// Colliders that stand still are found through avian's trees. Colliders that can move are found through a tree of
/// their own, over their bounds in the last tick.
pub struct AvianTerrain<'a> {
    world: &'a AvianObstacles<'a, 'a>,
    filter: SpatialQueryFilter,
    origin: DVec3,
}

/// The first hit of a ray.
struct RayHit {
    distance: f32,
    entity: Entity,
    normal: Vec3,
    pose: RigidPose,
}

impl<'a> AvianTerrain<'a> {
    pub(super) fn new(world: &'a AvianObstacles<'a, 'a>, filter: SpatialQueryFilter) -> Self {
        Self {
            world,
            filter,
            origin: DVec3::ZERO,
        }
    }

    /// Sets the position of avian's origin in world space, for scenes that are too large for f32. Default: zero.
    #[must_use]
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Restricts which colliders are seen: to some collision layers, or to all but some entities.
    #[must_use]
    pub fn with_filter(mut self, filter: SpatialQueryFilter) -> Self {
        self.filter = filter;
        self
    }

    fn local(&self, point: DVec3) -> Option<Vec3> {
        let local = (point - self.origin).as_vec3();
        local.is_finite().then_some(local)
    }

    /// A collider that the filter lets through, and its pose.
    fn solid(&self, entity: Entity) -> Option<(&Collider, RigidPose)> {
        let (position, rotation, collider, layers) = self.world.solids.get(entity).ok()?;
        let layers = layers.copied().unwrap_or_default();
        if !self.filter.test(entity, layers) {
            return None;
        }
        let moving = self.world.moving.pose(entity);
        let pose = moving.unwrap_or_else(|| RigidPose::new(rotation.0, position.0));
        Some((collider, pose))
    }

    /// Calls `visit` with the colliders that may lie in a box.
    fn near(&self, bounds: &Aabb, visit: &mut dyn FnMut(Entity)) {
        self.near_still(bounds, visit);
        for moving in self.world.moving.near(bounds) {
            if moving.bounds.intersects(bounds) {
                visit(moving.entity);
            }
        }
    }

    /// Calls `visit` with the colliders that stand still and may lie in a box.
    fn near_still(&self, bounds: &Aabb, visit: &mut dyn FnMut(Entity)) {
        let trees = &self.world.trees;
        let still = ColliderAabb::from_min_max(bounds.mins, bounds.maxs);
        for tree in [&trees.static_tree, &trees.standalone_tree] {
            tree.aabb_traverse(still.into(), |proxy| {
                if let Some(proxy) = tree.get_proxy(proxy) {
                    visit(proxy.collider);
                }
                true
            });
        }
    }

    /// Tries the colliders that stand still, and the moving ones with the box and the motion that `moving` returns.
    fn first_contact(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        moving: impl Fn(&MovingBody) -> (Aabb, Tick),
        mut meet: impl FnMut(&mut FirstContact, &Collider, &Tick, u64),
    ) -> Option<SweepContact> {
        let mut first = FirstContact::new(&capsule.moved(-self.origin), displacements)?;
        self.near_still(&first.bounds(), &mut |entity| {
            if let Some((collider, pose)) = self.solid(entity) {
                meet(&mut first, collider, &Tick::still(pose), entity.to_bits());
            }
        });
        let reach = first.bounds();
        for body in self.world.moving.near(&reach) {
            let (bounds, tick) = moving(body);
            if first.may_meet(&bounds)
                && let Some((collider, _)) = self.solid(body.entity)
            {
                meet(&mut first, collider, &tick, body.entity.to_bits());
            }
        }
        first.contact(self.origin)
    }

    /// Casts a ray at one collider and keeps the nearest hit; ties go to the smaller entity. Returns this collider's
    /// distance, `f32::MAX` for a miss.
    fn meet(&self, entity: Entity, ray: &Ray, limit: f32, best: &mut Option<RayHit>) -> f32 {
        let met = self.solid(entity).and_then(|(collider, pose)| {
            let shape = collider.shape_scaled();
            let hit = shape.cast_ray_and_get_normal(&in_f32(&pose), ray, limit, true)?;
            Some(RayHit {
                distance: hit.time_of_impact,
                entity,
                normal: hit.normal,
                pose,
            })
        });
        let Some(hit) = met else {
            return f32::MAX;
        };
        let distance = hit.distance;
        let nearer = |best: &RayHit| (distance, entity) < (best.distance, best.entity);
        if best.as_ref().is_none_or(nearer) {
            *best = Some(hit);
        }
        distance
    }

    fn contact(
        &self,
        entity: Entity,
        pose: &RigidPose,
        point: Vec3,
        normal: Vec3,
        distance: f64,
    ) -> Contact {
        let on_collider = pose.inverse_transform(point.as_dvec3());
        Contact {
            point: point.as_dvec3() + self.origin,
            normal: normal.as_dvec3().normalize_or(DVec3::Y),
            distance,
            material: MaterialPoint {
                key: entity.to_bits(),
                coordinates: on_collider.to_array(),
            },
            tag: SurfaceTag::default(),
        }
    }

    /// A radius around `point` that reaches all colliders.
    fn reach_of_all(&self, point: Vec3) -> f64 {
        let trees = &self.world.trees;
        let trees = [&trees.static_tree, &trees.standalone_tree].into_iter();
        let still = trees.filter_map(|tree| {
            let all = tree.bvh.nodes.first()?.aabb();
            Some((Vec3::from(all.min), Vec3::from(all.max)))
        });
        let moving = self.world.moving.iter();
        let moving = moving.map(|moving| (moving.bounds.mins, moving.bounds.maxs));
        let reaches = still.chain(moving).map(|(low, high)| {
            let farthest = (high - point).abs().max((low - point).abs());
            farthest.as_dvec3().length()
        });
        reaches.fold(0.0, f64::max)
    }
}

impl Obstacle for AvianTerrain<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let start = self.local(origin)?;
        let along = Dir3::new(direction.try_normalize()?.as_vec3()).ok()?;
        if max_distance.is_nan() || max_distance < 0.0 {
            return None;
        }
        let ray = Ray::new(start, *along);
        let limit = (max_distance as f32).next_up().min(f32::MAX);
        let search = (limit * (1.0 + LOOSE) + LOOSE).min(f32::MAX);
        let trees = &self.world.trees;
        let mut best = None;
        for tree in [&trees.static_tree, &trees.standalone_tree] {
            tree.ray_traverse_closest(Ray3d::new(start, along), search, |proxy| {
                tree.get_proxy(proxy).map_or(f32::MAX, |proxy| {
                    self.meet(proxy.collider, &ray, limit, &mut best)
                })
            });
        }
        for moving in self.world.moving.along(&ray, search) {
            if moving.bounds.intersects_local_ray(&ray, search) {
                self.meet(moving.entity, &ray, limit, &mut best);
            }
        }
        let hit = best?;
        let distance = f64::from(hit.distance);
        let point = ray.point_at(hit.distance);
        let contact = self.contact(hit.entity, &hit.pose, point, hit.normal, distance);
        (distance <= max_distance).then_some(contact)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let reach_of_all = self.reach_of_all(self.local(point)?);
        closest_by_overlap(max_distance, reach_of_all, |radius, contacts| {
            self.overlap_sphere(point, radius, contacts);
        })
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let local = capsule.moved(-self.origin);
        let Some(reach) = SweptBounds::around(local.ends, capsule.radius) else {
            return;
        };
        let start = contacts.len();
        self.near(&reach.bounds(), &mut |entity| {
            let Some((collider, pose)) = self.solid(entity) else {
                return;
            };
            let ends = local.ends.map(|end| pose.inverse_transform(end));
            let shape = &**collider.shape_scaled();
            overlap_shape(shape, ends, capsule.radius, &mut |found| {
                contacts.push(found.in_world(&pose, self.origin, entity.to_bits()));
            });
        });
        sort_contacts(&mut contacts[start..]);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        self.first_contact(capsule, displacements, ticks(target), meet)
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let mut counts = |sweep: &SweepContact| {
            let mut sweep = *sweep;
            sweep.contact.point += self.origin;
            counts(&sweep)
        };
        let meet = |first: &mut FirstContact, collider: &Collider, tick: &Tick, key| {
            first.meet_where(&**collider.shape_scaled(), tick, key, &mut counts);
        };
        self.first_contact(capsule, displacements, ticks(target), meet)
    }

    fn rigid_body_id(&self, point: &MaterialPoint) -> u64 {
        point.key
    }

    fn inverse_effective_mass(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        let Some(entity) = Entity::try_from_bits(point.key) else {
            return 0.0;
        };
        let Some((_, pose)) = self.solid(entity) else {
            return 0.0;
        };
        let place = pose.transform(DVec3::from_array(point.coordinates));
        self.world.masses.response(entity, place, direction)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let entity = Entity::try_from_bits(point.key)?;
        let (collider, now) = self.solid(entity)?;
        let local = DVec3::from_array(point.coordinates);
        if !holds(&**collider.shape_scaled(), local) {
            return None;
        }
        let before = self.world.moving.previous_pose(entity);
        now.motion_since(&before.unwrap_or(now), local, self.origin, dt)
    }
}

/// Returns the bounds of a moving body during a cast, and its motion.
fn ticks(target: TargetMotion) -> fn(&MovingBody) -> (Aabb, Tick) {
    match target {
        TargetMotion::Still => |moving| (moving.bounds, Tick::still(moving.pose)),
        TargetMotion::Moving => over_tick,
    }
}

fn over_tick(moving: &MovingBody) -> (Aabb, Tick) {
    let tick = Tick {
        before: moving.before,
        now: moving.pose,
    };
    (moving.swept, tick)
}

fn meet(first: &mut FirstContact, collider: &Collider, tick: &Tick, key: u64) {
    first.meet(&**collider.shape_scaled(), tick, key);
}
