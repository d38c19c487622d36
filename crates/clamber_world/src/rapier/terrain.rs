use std::sync::OnceLock;

use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{BroadPhaseBvh, Collider, ColliderHandle, ColliderSet, Ray};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::pipeline::{PhysicsWorld, QueryFilter, QueryPipeline};

use super::BodyPoses;
use super::push::push_response;
use crate::shapes::{
    FirstContact, Moved, Reach, RigidPose, Tick, closest_by_overlap, overlap_shape, sort_contacts,
};
use crate::{Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, WorldCapsule};

static DISPATCHER: DefaultQueryDispatcher = DefaultQueryDispatcher;

/// Share of a ray's length that is searched beyond its end, so that what ends there is not missed by rounding.
const LOOSE: f32 = 1e-4;

/// Whether a collider is seen. Terrain is asked from many threads at once, so this is too; `QueryFilter` need not be.
type Filter<'a> = &'a (dyn Fn(ColliderHandle, &Collider) -> bool + Sync);

pub(super) fn pose_of(pose: &Pose) -> RigidPose {
    RigidPose::new(pose.rotation, pose.translation)
}

fn key_of(handle: ColliderHandle) -> u64 {
    let (index, generation) = handle.into_raw_parts();
    u64::from(generation) << 32 | u64::from(index)
}

/// The collider that a point lies on.
pub(super) fn handle_of(point: &MaterialPoint) -> ColliderHandle {
    ColliderHandle::from_raw_parts(point.key as u32, (point.key >> 32) as u32)
}

/// A rapier world as one obstacle: its colliders as of the last step (or collision detection),
/// without sensors.
///
/// Made anew each tick; it only borrows. Height fields and triangle meshes answer per triangle,
/// from both sides; convex shapes are solid. Rays are rapier's own: one that meets an edge between
/// two of its triangles exactly may slip through.
///
/// Sweeps see each point of a body go straight from where [`BodyPoses`] has it to where it is: for a body that turns by
/// an angle in a tick, up to `r (1 - cos(angle / 2))` beside its arc. The first of them in a tick looks once through the
/// bodies that were recorded, and takes memory for those that moved.
pub struct RapierTerrain<'a> {
    bodies: &'a RigidBodySet,
    colliders: &'a ColliderSet,
    broad_phase: &'a BroadPhaseBvh,
    filter: Option<Filter<'a>>,
    before: &'a BodyPoses,
    origin: DVec3,
    /// Made when first asked for.
    moved: OnceLock<MovedColliders>,
}

/// Colliders of bodies that are elsewhere than they were, and a tree over the boxes of their ways: rapier's own has them
/// where they are now.
struct MovedColliders {
    moved: Vec<(ColliderHandle, Moved)>,
    /// Leaves are places in `moved`.
    tree: Bvh,
}

impl MovedColliders {
    fn new(moved: Vec<(ColliderHandle, Moved)>) -> Self {
        let boxes: Vec<_> = moved.iter().map(|(_, moved)| moved.bounds).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Self { moved, tree }
    }
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
            moved: OnceLock::new(),
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
        let on_collider = collider.position().inverse_transform_point(point);
        Contact {
            point: point.as_dvec3() + self.origin,
            normal: normal.as_dvec3().normalize_or(DVec3::Y),
            distance,
            material: MaterialPoint {
                key: key_of(handle),
                coordinates: on_collider.as_dvec3().to_array(),
            },
            tag: SurfaceTag::default(),
        }
    }

    /// Where a collider was; `None` if it has not moved.
    fn previous_pose(&self, collider: &Collider) -> Option<RigidPose> {
        let body = collider.parent()?;
        let before = self.before.get(body)?;
        // Poses of colliders are products, which rounding may change where nothing moves.
        if self.bodies.get(body)?.position() == before {
            return None;
        }
        Some(pose_of(before).then(&pose_of(collider.position_wrt_parent()?)))
    }

    fn moved(&self) -> &MovedColliders {
        self.moved.get_or_init(|| {
            let bodies = self.before.moved(self.bodies);
            let handles = bodies.flat_map(|body| body.colliders().iter().copied());
            let moved = handles.filter_map(|handle| {
                let collider = self.colliders.get(handle)?;
                let before = self.previous_pose(collider)?;
                let now = pose_of(collider.position());
                Some((handle, Moved::new(collider.shape(), before, now)))
            });
            MovedColliders::new(moved.collect())
        })
    }

    /// Tries what moved, all along its way.
    fn meet_moved(&self, first: &mut FirstContact) {
        let queries = self.queries();
        let all = self.moved();
        all.tree.traverse(|node| {
            if !first.may_meet(&node.aabb()) {
                return TraversalAction::Prune;
            }
            let leaf = node.leaf_data();
            if let Some((handle, moved)) = leaf.and_then(|leaf| all.moved.get(leaf as usize))
                && let Some(collider) = self.colliders.get(*handle)
                && collider.is_enabled()
                && queries.filter.test(self.bodies, *handle, collider)
            {
                first.meet(collider.shape(), &moved.tick, key_of(*handle));
            }
            TraversalAction::Continue
        });
    }

    /// Tries what the broad phase finds in the way, as it stands now, if it is to be tried.
    fn meet_near(&self, first: &mut FirstContact, is_tried: impl Fn(&Collider) -> bool) {
        let queries = self.queries();
        queries.bvh.traverse(|node| {
            if !first.may_meet(&node.aabb()) {
                return TraversalAction::Prune;
            }
            let leaf = node.leaf_data();
            let collider = leaf.and_then(|leaf| self.colliders.get_unknown_gen(leaf));
            if let Some((collider, handle)) = collider
                && queries.filter.test(self.bodies, handle, collider)
                && is_tried(collider)
            {
                let tick = Tick::still(pose_of(collider.position()));
                first.meet(collider.shape(), &tick, key_of(handle));
            }
            TraversalAction::Continue
        });
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

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let local = capsule.moved(-self.origin);
        let radius = capsule.radius;
        let Some(reach) = Reach::around(local.ends, radius) else {
            return;
        };
        let start = contacts.len();
        for (handle, collider) in self.queries().intersect_aabb_conservative(reach.bounds()) {
            let pose = pose_of(collider.position());
            let ends = local.ends.map(|end| pose.inverse_transform(end));
            overlap_shape(collider.shape(), ends, radius, &mut |found| {
                contacts.push(found.in_world(&pose, self.origin, key_of(handle)));
            });
        }
        sort_contacts(&mut contacts[start..]);
    }

    fn cast_capsule(&self, capsule: &WorldCapsule, displacement: DVec3) -> Option<SweepContact> {
        let mut first = FirstContact::new(&capsule.moved(-self.origin), displacement)?;
        self.meet_near(&mut first, |_| true);
        first.contact(self.origin)
    }

    fn sweep_capsule(&self, capsule: &WorldCapsule, displacement: DVec3) -> Option<SweepContact> {
        let mut first = FirstContact::new(&capsule.moved(-self.origin), displacement)?;
        self.meet_near(&mut first, |collider| {
            self.previous_pose(collider).is_none()
        });
        self.meet_moved(&mut first);
        first.contact(self.origin)
    }

    fn push_response(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        push_response(self.bodies, self.colliders, point, direction)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let handle = handle_of(point);
        let collider = self.colliders.get(handle)?;
        let seen = self.queries().filter.test(self.bodies, handle, collider);
        if !collider.is_enabled() || !seen {
            return None;
        }
        let now = pose_of(collider.position());
        let before = self.previous_pose(collider);
        let local = DVec3::from_array(point.coordinates);
        now.motion_since(&before.unwrap_or(now), local, self.origin, dt)
    }
}

#[cfg(test)]
mod tests;
