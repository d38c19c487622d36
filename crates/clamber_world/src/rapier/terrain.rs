use std::cmp::Ordering;

use clamber_surface::mesh::SurfaceTag;
use glam::{DQuat, DVec3};
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{Aabb, BroadPhaseBvh, Collider, ColliderHandle, ColliderSet, Ray};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::pipeline::{PhysicsWorld, QueryFilter, QueryPipeline};

use super::BodyPoses;
use super::narrow::overlap;
use crate::{Contact, MaterialPoint, Obstacle, PointMotion};

static DISPATCHER: DefaultQueryDispatcher = DefaultQueryDispatcher;

/// First radius, in metres, of the search for the closest point; it doubles until something lies
/// within. Larger looks at more triangles where something is near, smaller searches longer where
/// nothing is.
const FIRST_REACH: f64 = 1.0;

/// A rapier world as one obstacle: its colliders as of the last step (or collision detection),
/// without sensors.
///
/// Made anew each tick; it only borrows. Height fields and triangle meshes answer per triangle,
/// from both sides; convex shapes are solid. Rays are rapier's own: one that meets an edge between
/// two of its triangles exactly may slip through.
pub struct RapierTerrain<'a> {
    queries: QueryPipeline<'a>,
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
        let filter = QueryFilter::new().exclude_sensors();
        Self {
            queries: broad_phase.as_query_pipeline(&DISPATCHER, bodies, colliders, filter),
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

    /// Restricts what is seen, to groups or by a predicate of one's own.
    #[must_use]
    pub fn with_filter(mut self, filter: QueryFilter<'a>) -> Self {
        self.queries = self.queries.with_filter(filter.exclude_sensors());
        self
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
        let all = self.queries.bvh.root_aabb();
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
        let limit = (max_distance as f32).min(f32::MAX);
        let (handle, hit) = self.queries.cast_ray_and_get_normal(&ray, limit, true)?;
        let collider = self.queries.colliders.get(handle)?;
        let point = ray.point_at(hit.time_of_impact);
        // Rapier turns the normals of triangles towards the ray; both sides are solid to it.
        let distance = f64::from(hit.time_of_impact);
        Some(self.contact(handle, collider, point, hit.normal, distance))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        if max_distance.is_nan() {
            return None;
        }
        let limit = max_distance.min(self.reach_of_all(self.local(point)?) * 1.001);
        let mut contacts = Vec::new();
        let mut reach = FIRST_REACH.min(limit);
        loop {
            self.overlap_sphere(point, reach, &mut contacts);
            let nearest = contacts.iter().copied().min_by(|a, b| {
                let by_key = a.material.key.cmp(&b.material.key);
                a.distance.total_cmp(&b.distance).then(by_key)
            });
            if nearest.is_some() || reach >= limit {
                return nearest.filter(|contact| contact.distance <= max_distance);
            }
            reach = (reach * 2.0).min(limit);
        }
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
        for (handle, collider) in self.queries.intersect_aabb_conservative(near) {
            let pose = collider.position();
            let on_shape = pose.inverse_transform_point(local);
            overlap(collider.shape(), on_shape, radius, &mut |found| {
                let point = pose.transform_point(found.point);
                let normal = pose.transform_vector(found.normal);
                let distance = f64::from(found.distance);
                contacts.push(self.contact(handle, collider, point, normal, distance));
            });
        }
        // By place within one collider, so that the order of its tree does not matter; in place, so
        // that a steady tick allocates nothing.
        contacts[start..].sort_unstable_by(|a, b| {
            let by_place = a.material.coordinates.iter().zip(&b.material.coordinates);
            let by_place = by_place.map(|(a, b)| a.total_cmp(b));
            let by_key = a.material.key.cmp(&b.material.key);
            by_key.then(by_place.fold(Ordering::Equal, Ordering::then))
        });
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let handle = ColliderHandle::from_raw_parts(point.key as u32, (point.key >> 32) as u32);
        let collider = self.queries.colliders.get(handle)?;
        let (filter, bodies) = (&self.queries.filter, self.queries.bodies);
        if !collider.is_enabled() || !filter.test(bodies, handle, collider) {
            return None;
        }
        let now = PoseF64::new(collider.position());
        let before = collider.parent().and_then(|body| {
            let on_body = collider.position_wrt_parent()?;
            let body = PoseF64::new(self.before.get(body)?);
            Some(body.then(&PoseF64::new(on_body)))
        });
        let before = before.unwrap_or(now);
        let local = DVec3::from_array(point.coordinates);
        let position = now.transform(local) + self.origin;
        let previous_position = before.transform(local) + self.origin;
        let usable = dt > 0.0 && position.is_finite();
        usable.then(|| PointMotion {
            position,
            previous_position,
            velocity: (position - previous_position) / dt,
            frame: Some(now.rotation),
            turn: (now.rotation * before.rotation.conjugate()).normalize(),
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        })
    }
}

/// A rigid pose in f64: rapier's own rounds in f32 with every product.
#[derive(Clone, Copy)]
struct PoseF64 {
    rotation: DQuat,
    translation: DVec3,
}

impl PoseF64 {
    fn new(pose: &Pose) -> Self {
        Self {
            rotation: pose.rotation.as_dquat().normalize(),
            translation: pose.translation.as_dvec3(),
        }
    }

    fn then(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.transform(inner.translation),
        }
    }

    fn transform(&self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }
}

#[cfg(test)]
mod tests;
