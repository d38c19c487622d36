use std::sync::OnceLock;

use clamber_surface::mesh::SurfaceTag;
use glam::DVec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{BroadPhaseBvh, Collider, ColliderHandle, ColliderSet, Ray};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::Shape;
use rapier3d::pipeline::{PhysicsWorld, QueryFilter, QueryPipeline};

use super::BodyPoses;
use super::push::inverse_effective_mass;
use crate::shapes::{
    FirstContact, Moved, SweptBounds, Tick, closest_by_overlap, holds, overlap_shape, sort_contacts,
};
use crate::{
    Contact, MaterialPoint, Obstacle, PointMotion, RigidPose, SweepContact, TargetMotion,
    WorldCapsule,
};

static DISPATCHER: DefaultQueryDispatcher = DefaultQueryDispatcher;

/// Rays are searched beyond their end by this fraction of their length, and by this many metres, so that rounding does
/// not miss a surface at the end.
const LOOSE: f32 = 1e-4;

/// Decides whether queries see a collider. Many threads query terrain at once, so the filter is `Sync`, which rapier
/// does not require of a `QueryFilter`.
type Filter<'a> = &'a (dyn Fn(ColliderHandle, &Collider) -> bool + Sync);

/// Returns the tag of a collider.
type Tags<'a> = &'a (dyn Fn(ColliderHandle, &Collider) -> SurfaceTag + Sync);

pub(super) fn pose_of(pose: &Pose) -> RigidPose {
    RigidPose::new(pose.rotation, pose.translation)
}

pub(super) fn key_of(handle: ColliderHandle) -> u64 {
    let (index, generation) = handle.into_raw_parts();
    u64::from(generation) << 32 | u64::from(index)
}

/// A rapier world as one obstacle: its enabled colliders as of the last step (or collision detection), without sensors.
///
/// Create one each tick; it only borrows the world. Height fields and triangle meshes report contacts per triangle,
/// from both sides; convex shapes are solid. A custom shape is seen by its support map or by its parts, and otherwise
/// by rays only. Ray casts are rapier's own: a ray that exactly meets an edge between two triangles may slip through.
///
/// The skin patches of [`Debris`](crate::Debris) are colliders of the world. Without a filter, a climber touches that
/// skin twice: here, and on the creature itself. Leave the patches out with [`RapierTerrain::with_filter`], by
/// [`DebrisConfig::groups`](crate::DebrisConfig::groups) or by [`Debris::triangle_at`](crate::Debris::triangle_at).
///
/// In sweeps, each point of a body moves in a straight line from its position in [`BodyPoses`] to its current one. If
/// the body turns by an angle in a tick, a point at the distance r from the axis is off its arc by up to
/// `r (1 - cos(angle / 2))`. The first sweep in a tick iterates over all recorded bodies, and allocates memory for
/// those that moved.
pub struct RapierTerrain<'a> {
    bodies: &'a RigidBodySet,
    colliders: &'a ColliderSet,
    broad_phase: &'a BroadPhaseBvh,
    filter: Option<Filter<'a>>,
    tags: Option<Tags<'a>>,
    before: &'a BodyPoses,
    origin: DVec3,
    /// Built on first use.
    moved: OnceLock<MovedColliders>,
}

/// Largest number of moved colliders that are tested one by one: that is faster than building a tree.
const FEW: usize = 8;

/// Colliders of bodies whose pose has changed, and a tree over the boxes of their paths. Rapier's own tree has only
/// their current boxes.
struct MovedColliders {
    moved: Vec<(ColliderHandle, Moved)>,
    /// Leaves are indices into `moved`. `None` for at most [`FEW`] colliders.
    tree: Option<Bvh>,
}

impl MovedColliders {
    fn new(moved: Vec<(ColliderHandle, Moved)>) -> Self {
        let tree = (moved.len() > FEW).then(|| {
            let boxes: Vec<_> = moved.iter().map(|(_, moved)| moved.bounds).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        });
        Self { moved, tree }
    }
}

impl<'a> RapierTerrain<'a> {
    /// An obstacle made of rapier's sets. `before` holds the bodies' poses before the last step. A body without a pose
    /// there counts as one that has not moved; if `before` is empty, nothing in the world moves.
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
            tags: None,
            before,
            origin: DVec3::ZERO,
            moved: OnceLock::new(),
        }
    }

    /// An obstacle made of rapier's all-in-one world.
    pub fn of_world(world: &'a PhysicsWorld, before: &'a BodyPoses) -> Self {
        Self::new(&world.bodies, &world.colliders, &world.broad_phase, before)
    }

    /// Sets the world position of rapier's origin, for scenes far larger than f32 can resolve. Zero by default.
    #[must_use]
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// Restricts queries to the colliders that a function accepts: the colliders of some groups, or all but a body's
    /// own, as `|_, collider| collider.parent() != Some(body)`.
    #[must_use]
    pub fn with_filter(
        mut self,
        filter: &'a (dyn Fn(ColliderHandle, &Collider) -> bool + Sync),
    ) -> Self {
        self.filter = Some(filter);
        self
    }

    /// Sets a function that returns the tag of a collider, so that a climber recognises fur and ledges, and contacts
    /// carry the game's own number. Without it, every collider has the default tag. Bits of a collider's `user_data`
    /// are a good place to store the tag.
    ///
    /// ```
    /// # use clamber_world::{BodyPoses, Obstacle, RapierTerrain, SurfaceKind, SurfaceTag};
    /// # use clamber_world::rapier3d::prelude::*;
    /// # use glam::DVec3;
    /// let mut world = PhysicsWorld::default();
    /// let ivy = ColliderBuilder::cuboid(1.0, 4.0, 0.1).user_data(1);
    /// let ivy = world.insert_collider(ivy, None);
    /// world.step();
    /// let before = BodyPoses::new();
    /// let tags = |_, collider: &Collider| match collider.user_data {
    ///     1 => SurfaceTag::new(SurfaceKind::Fur),
    ///     _ => SurfaceTag::default(),
    /// };
    /// let terrain = RapierTerrain::of_world(&world, &before).with_tags(&tags);
    /// let contact = terrain.closest_point(DVec3::Z, 2.0).unwrap();
    /// assert_eq!(contact.tag.kind, SurfaceKind::Fur);
    /// assert_eq!(RapierTerrain::collider_of(&contact.material), ivy);
    /// ```
    #[must_use]
    pub fn with_tags(
        mut self,
        tags: &'a (dyn Fn(ColliderHandle, &Collider) -> SurfaceTag + Sync),
    ) -> Self {
        self.tags = Some(tags);
        self
    }

    /// Handle of the collider that a material point of a rapier world lies on. The collider may have been removed
    /// since. For a point of any other obstacle, the handle has no meaning.
    pub fn collider_of(point: &MaterialPoint) -> ColliderHandle {
        ColliderHandle::from_raw_parts(point.key as u32, (point.key >> 32) as u32)
    }

    /// True if queries see a collider: it is enabled, it is no sensor, and the caller's filter accepts it.
    ///
    /// Checked in every query, since rapier's tree keeps a disabled collider until the next step.
    fn sees(&self, handle: ColliderHandle, collider: &Collider) -> bool {
        collider.is_enabled()
            && !collider.is_sensor()
            && self.filter.is_none_or(|filter| filter(handle, collider))
    }

    fn tag(&self, handle: ColliderHandle, collider: &Collider) -> SurfaceTag {
        self.tags
            .map_or_else(SurfaceTag::default, |tags| tags(handle, collider))
    }

    /// Sets the tag of a sweep's contact.
    fn tagged(&self, mut sweep: SweepContact) -> SweepContact {
        let handle = Self::collider_of(&sweep.contact.material);
        if let Some(collider) = self.colliders.get(handle) {
            sweep.contact.tag = self.tag(handle, collider);
        }
        sweep
    }

    /// Runs rapier's own queries on the colliders that [`RapierTerrain::sees`] accepts.
    fn with_queries<R>(&self, ask: impl FnOnce(&QueryPipeline<'_>) -> R) -> R {
        let sees = |handle, collider: &Collider| self.sees(handle, collider);
        let filter = QueryFilter::new().predicate(&sees);
        ask(&self
            .broad_phase
            .as_query_pipeline(&DISPATCHER, self.bodies, self.colliders, filter))
    }

    /// Rapier's tree over all colliders, seen or not.
    fn tree(&self) -> &Bvh {
        let filter = QueryFilter::new();
        self.broad_phase
            .as_query_pipeline(&DISPATCHER, self.bodies, self.colliders, filter)
            .bvh
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
            tag: self.tag(handle, collider),
        }
    }

    /// Pose of a collider's body before the last step; `None` if it has not moved.
    fn previous_body_pose(&self, collider: &Collider) -> Option<&Pose> {
        let body = collider.parent()?;
        let before = self.before.get(body)?;
        // A collider's pose is a product of poses, which rounding may change although the body is at rest. So compare
        // the bodies' poses.
        (self.bodies.get(body)?.position() != before).then_some(before)
    }

    /// Pose of a collider before the last step; `None` if it has not moved.
    fn previous_pose(&self, collider: &Collider) -> Option<RigidPose> {
        let before = self.previous_body_pose(collider)?;
        Some(pose_of(before).compose(&pose_of(collider.position_wrt_parent()?)))
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

    /// Calls `meet` for every collider that the capsule may touch, in its current pose or on the path to it.
    fn meet(&self, first: &mut FirstContact, target: TargetMotion, meet: &mut Meet<'_>) {
        match target {
            TargetMotion::Still => self.meet_near(first, |_| true, meet),
            TargetMotion::Moving => {
                let is_still = |collider: &Collider| self.previous_body_pose(collider).is_none();
                self.meet_near(first, is_still, meet);
                self.meet_moved(first, meet);
            }
        }
    }

    /// Calls `meet` for colliders that have moved, over their whole paths.
    fn meet_moved(&self, first: &mut FirstContact, meet: &mut Meet<'_>) {
        let all = self.moved();
        let mut try_one = |first: &mut FirstContact, (handle, moved): &(ColliderHandle, Moved)| {
            if let Some(collider) = self.colliders.get(*handle)
                && self.sees(*handle, collider)
            {
                let met = Met {
                    shape: collider.shape(),
                    tick: moved.tick,
                    key: key_of(*handle),
                };
                meet(first, &met);
            }
        };
        let Some(tree) = &all.tree else {
            for one in &all.moved {
                if first.may_meet(&one.1.bounds) {
                    try_one(first, one);
                }
            }
            return;
        };
        tree.traverse(|node| {
            if !first.may_meet(&node.aabb()) {
                return TraversalAction::Prune;
            }
            let leaf = node.leaf_data();
            if let Some(one) = leaf.and_then(|leaf| all.moved.get(leaf as usize)) {
                try_one(first, one);
            }
            TraversalAction::Continue
        });
    }

    /// Calls `meet` for colliders in the capsule's way, in their current pose, that `is_tried` accepts.
    fn meet_near(
        &self,
        first: &mut FirstContact,
        is_tried: impl Fn(&Collider) -> bool,
        meet: &mut Meet<'_>,
    ) {
        self.tree().traverse(|node| {
            if !first.may_meet(&node.aabb()) {
                return TraversalAction::Prune;
            }
            let leaf = node.leaf_data();
            let collider = leaf.and_then(|leaf| self.colliders.get_unknown_gen(leaf));
            if let Some((collider, handle)) = collider
                && self.sees(handle, collider)
                && is_tried(collider)
            {
                let met = Met {
                    shape: collider.shape(),
                    tick: Tick::still(pose_of(collider.position())),
                    key: key_of(handle),
                };
                meet(first, &met);
            }
            TraversalAction::Continue
        });
    }

    /// A radius about `point` that contains all colliders.
    fn reach_of_all(&self, point: Vector) -> f64 {
        let all = self.tree().root_aabb();
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
        let (handle, hit) =
            self.with_queries(|queries| queries.cast_ray_and_get_normal(&ray, limit, true))?;
        if f64::from(hit.time_of_impact) > max_distance {
            return None;
        }
        let collider = self.colliders.get(handle)?;
        let point = ray.point_at(hit.time_of_impact);
        // Rapier turns the normals of triangles towards the ray; a triangle is hit from both sides.
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
        let Some(reach) = SweptBounds::around(local.ends, radius) else {
            return;
        };
        let start = contacts.len();
        self.with_queries(|queries| {
            for (handle, collider) in queries.intersect_aabb_conservative(reach.bounds()) {
                let pose = pose_of(collider.position());
                let [a, b] = local.ends;
                let ends = [pose.inverse_transform(a), pose.inverse_transform(b)];
                let tag = self.tag(handle, collider);
                overlap_shape(collider.shape(), ends, radius, &mut |found| {
                    let contact = found.in_world(&pose, self.origin, key_of(handle));
                    contacts.push(Contact { tag, ..contact });
                });
            }
        });
        sort_contacts(&mut contacts[start..]);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let mut first = FirstContact::new(&capsule.moved(-self.origin), displacements)?;
        self.meet(&mut first, target, &mut |first, met| {
            first.meet(met.shape, &met.tick, met.key);
        });
        Some(self.tagged(first.contact(self.origin)?))
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let mut first = FirstContact::new(&capsule.moved(-self.origin), displacements)?;
        let mut counts = |sweep: &SweepContact| {
            let mut sweep = *sweep;
            sweep.contact.point += self.origin;
            counts(&self.tagged(sweep))
        };
        self.meet(&mut first, target, &mut |first, met| {
            first.meet_where(met.shape, &met.tick, met.key, &mut counts);
        });
        Some(self.tagged(first.contact(self.origin)?))
    }

    fn inverse_effective_mass(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        inverse_effective_mass(self.bodies, self.colliders, point, direction)
    }

    fn rigid_body_id(&self, point: &MaterialPoint) -> u64 {
        point.key
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let handle = Self::collider_of(point);
        let collider = self.colliders.get(handle)?;
        let local = DVec3::from_array(point.coordinates);
        if !self.sees(handle, collider) || !holds(collider.shape(), local) {
            return None;
        }
        let now = pose_of(collider.position());
        let before = self.previous_pose(collider);
        now.motion_since(&before.unwrap_or(now), local, self.origin, dt)
    }

    fn rests(&self, point: &MaterialPoint) -> bool {
        let handle = Self::collider_of(point);
        self.colliders.get(handle).is_some_and(|collider| {
            self.sees(handle, collider) && self.previous_body_pose(collider).is_none()
        })
    }
}

/// A collider that a sweep may meet.
struct Met<'a> {
    shape: &'a dyn Shape,
    tick: Tick,
    key: u64,
}

type Meet<'a> = dyn FnMut(&mut FirstContact, &Met<'_>) + 'a;

#[cfg(test)]
mod tests;
