use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{Aabb, BroadPhaseBvh, Collider, ColliderHandle, ColliderSet, Ray};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::pipeline::{PhysicsWorld, QueryFilter, QueryPipeline};

use super::BodyPoses;
use crate::shapes::{RigidPose, closest_by_overlap, overlap_shape, sort_contacts};
use crate::{Contact, MaterialPoint, Obstacle, PointMotion};

static DISPATCHER: DefaultQueryDispatcher = DefaultQueryDispatcher;

/// Share of a ray's length that is searched beyond its end, so that what ends there is not missed by rounding.
const LOOSE: f32 = 1e-4;

/// Whether a collider is seen. Terrain is asked from many threads at once, so this is too; `QueryFilter` need not be.
type Filter<'a> = &'a (dyn Fn(ColliderHandle, &Collider) -> bool + Sync);

/// A rapier world as one obstacle: its colliders as of the last step (or collision detection),
/// without sensors.
///
/// Made anew each tick; it only borrows. Height fields and triangle meshes answer per triangle,
/// from both sides; convex shapes are solid. Rays are rapier's own: one that meets an edge between
/// two of its triangles exactly may slip through.
pub struct RapierTerrain<'a> {
    bodies: &'a RigidBodySet,
    colliders: &'a ColliderSet,
    broad_phase: &'a BroadPhaseBvh,
    filter: Option<Filter<'a>>,
    before: &'a BodyPoses,
    origin: DVec3,
}

impl<'a> RapierTerrain<'a> {
    /// From the sets that an engine owns. `before` tells where bodies stood before the last step;
    /// without it, nothing of the world moves.
    pub fn new(
        bodies: &'a RigidBodySet,
        colliders: &'a ColliderSet,
        broad_phase: &'a BroadPhaseBvh,
        before: &'a BodyPoses,
    ) -> Self {
        Self {
            bodies,
            colliders,
            broad_phase,
            filter: None,
            before,
            origin: DVec3::ZERO,
        }
    }

    /// From rapier's all-in-one world.
    pub fn of_world(world: &'a PhysicsWorld, before: &'a BodyPoses) -> Self {
        Self::new(&world.bodies, &world.colliders, &world.broad_phase, before)
    }

    /// Where rapier's origin stands in the world, for scenes that are far larger than f32 can
    /// resolve. Zero if not said.
    #[must_use]
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Restricts what is seen to colliders that a function says yes to: those of groups, or all but a body's own, as
    /// `|_, collider| collider.parent() != Some(body)`.
    #[must_use]
    pub fn with_filter(
        mut self,
        filter: &'a (dyn Fn(ColliderHandle, &Collider) -> bool + Sync),
    ) -> Self {
        self.filter = Some(filter);
        self
    }

    fn queries(&self) -> QueryPipeline<'_> {
        let filter = QueryFilter {
            predicate: self.filter.map(|filter| filter as &_),
            ..QueryFilter::new().exclude_sensors()
        };
        self.broad_phase
            .as_query_pipeline(&DISPATCHER, self.bodies, self.colliders, filter)
    }

    fn local(&self, point: DVec3) -> Option<Vector> {
        let local = (point - self.origin).as_vec3();
        local.is_finite().then_some(local)
    }

    fn contact(
        &self,
        handle: ColliderHandle,
        collider: &Collider,
        point: Vector,
        normal: Vector,
        distance: f64,
    ) -> Contact {
        let (index, generation) = handle.into_raw_parts();
        let on_collider = collider.position().inverse_transform_point(point);
        Contact {
            point: point.as_dvec3() + self.origin,
            normal: normal.as_dvec3().normalize_or(DVec3::Y),
            distance,
            material: MaterialPoint {
                key: u64::from(generation) << 32 | u64::from(index),
                coordinates: on_collider.as_dvec3().to_array(),
            },
            tag: SurfaceTag::default(),
        }
    }

    /// A radius about `point` that reaches everything.
    fn reach_of_all(&self, point: Vector) -> f64 {
        let all = self.queries().bvh.root_aabb();
        let farthest = (all.maxs - point).abs().max((all.mins - point).abs());
        farthest.as_dvec3().length()
    }
}

impl Obstacle for RapierTerrain<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let start = self.local(origin)?;
        let along = direction.try_normalize()?;
        if max_distance.is_nan() || max_distance < 0.0 {
            return None;
        }
        let ray = Ray::new(start, along.as_vec3());
        let limit = (max_distance as f32 * (1.0 + LOOSE) + LOOSE).min(f32::MAX);
        let (handle, hit) = self.queries().cast_ray_and_get_normal(&ray, limit, true)?;
        if f64::from(hit.time_of_impact) > max_distance {
            return None;
        }
        let collider = self.colliders.get(handle)?;
        let point = ray.point_at(hit.time_of_impact);
        // Rapier turns the normals of triangles towards the ray; both sides are solid to it.
        let distance = f64::from(hit.time_of_impact);
        Some(self.contact(handle, collider, point, hit.normal, distance))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let reach_of_all = self.reach_of_all(self.local(point)?);
        closest_by_overlap(max_distance, reach_of_all, |radius, contacts| {
            self.overlap_sphere(point, radius, contacts);
        })
    }

    fn overlap_sphere(&self, center: DVec3, radius: f64, contacts: &mut Vec<Contact>) {
        let Some(local) = self.local(center) else {
            return;
        };
        let radius = radius as f32;
        if radius.is_nan() || radius < 0.0 {
            return;
        }
        let start = contacts.len();
        let reach = Vector::splat(radius);
        let near = Aabb::new(local - reach, local + reach);
        for (handle, collider) in self.queries().intersect_aabb_conservative(near) {
            let pose = collider.position();
            let on_shape = pose.inverse_transform_point(local);
            overlap_shape(collider.shape(), on_shape, radius, &mut |found| {
                let point = pose.transform_point(found.point);
                let normal = pose.transform_vector(found.normal);
                let distance = f64::from(found.distance);
                contacts.push(self.contact(handle, collider, point, normal, distance));
            });
        }
        sort_contacts(&mut contacts[start..]);
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let handle = ColliderHandle::from_raw_parts(point.key as u32, (point.key >> 32) as u32);
        let collider = self.colliders.get(handle)?;
        let seen = self.queries().filter.test(self.bodies, handle, collider);
        if !collider.is_enabled() || !seen {
            return None;
        }
        let pose = |pose: &Pose| RigidPose::new(pose.rotation, pose.translation);
        let now = pose(collider.position());
        let before = collider.parent().and_then(|body| {
            let on_body = collider.position_wrt_parent()?;
            Some(pose(self.before.get(body)?).then(&pose(on_body)))
        });
        let local = DVec3::from_array(point.coordinates);
        now.motion_since(&before.unwrap_or(now), local, self.origin, dt)
    }
}

#[cfg(test)]
mod tests;
