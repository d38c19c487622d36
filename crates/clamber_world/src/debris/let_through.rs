//! Bodies caught between skin and something immovable: under a foot, or between a flank and a cliff. No body pushes a
//! creature, so the skin passes through the caught body. It also passes through bodies around which it has appeared.

use clamber_surface::geometry;
use clamber_surface::surface::{SkinnedSurface, SurfaceHit};
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{
    BroadPhaseBvh, Capsule, Collider, ColliderHandle, ColliderSet, NarrowPhase,
};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query::{DefaultQueryDispatcher, ShapeCastOptions};
use rapier3d::pipeline::QueryFilter;

use super::enclosed::is_within;
use super::hull::Hull;
use super::inner_capsule::InnerCapsule;
use super::keep_out::SWEPT;

static DISPATCHER: DefaultQueryDispatcher = DefaultQueryDispatcher;

/// The colliders of rapier's world that do not give way and are not skin.
#[derive(Clone, Copy)]
pub(super) struct Immovable<'a> {
    pub(super) colliders: &'a ColliderSet,
    pub(super) broad_phase: &'a BroadPhaseBvh,
    pub(super) narrow_phase: &'a NarrowPhase,
    /// Colliders of skin patches with their owners, by ascending handle.
    pub(super) skin: &'a [(ColliderHandle, RigidBodyHandle)],
}

impl Immovable<'_> {
    /// The place up to which a step of `dt` seconds could take the body from the pose `start` without pressing it into
    /// immovable colliders, in rapier's space. `None` if the body touches none, or is not pressed into any.
    ///
    /// A body that moves evenly with such a collider is not pressed into it, however fast both are.
    pub(super) fn pressed(
        &self,
        bodies: &RigidBodySet,
        body: &RigidBody,
        core: &InnerCapsule,
        start: &Pose,
        dt: f64,
    ) -> Option<Vector> {
        let mut least: Option<(f64, Vector)> = None;
        let mut tried = None;
        for own in body.colliders() {
            for pair in self.narrow_phase.contact_pairs_with(*own) {
                let other = if pair.collider1 == *own {
                    pair.collider2
                } else {
                    pair.collider1
                };
                let Some(velocity) = self.velocity(bodies, other, body.translation()) else {
                    continue;
                };
                if tried == Some(velocity) || !pair.has_any_active_contact() {
                    continue;
                }
                tried = Some(velocity);
                let mut from = *start;
                from.translation += (velocity.as_dvec3() * dt).as_vec3();
                let moved = (body.translation() - from.translation).as_dvec3();
                if let Some(share) = self.blocks(bodies, core, &from, moved)
                    && least.is_none_or(|(known, _)| share < known)
                {
                    least = Some((share, from.translation + (moved * share).as_vec3()));
                }
            }
        }
        least.map(|(_, place)| place)
    }

    /// Velocity of an immovable collider at a place in rapier's space, metres a second; `None` for any other collider.
    fn velocity(
        &self,
        bodies: &RigidBodySet,
        handle: ColliderHandle,
        place: Vector,
    ) -> Option<Vector> {
        let parent = self.colliders.get(handle)?.parent();
        let body = parent.and_then(|parent| bodies.get(parent));
        if body.is_some_and(RigidBody::is_dynamic) || owner_in(self.skin, handle).is_some() {
            return None;
        }
        Some(body.map_or(Vector::ZERO, |body| body.velocity_at_point(place)))
    }

    /// The fraction of a displacement, by `shift` from a pose in rapier's space, at which the body's inside meets an
    /// immovable collider; `None` if it meets none.
    pub(super) fn blocks(
        &self,
        bodies: &RigidBodySet,
        core: &InnerCapsule,
        pose: &Pose,
        shift: DVec3,
    ) -> Option<f64> {
        let is_no_skin = |handle, _: &Collider| owner_in(self.skin, handle).is_none();
        let filter = QueryFilter::exclude_dynamic()
            .exclude_sensors()
            .predicate(&is_no_skin);
        let world = self
            .broad_phase
            .as_query_pipeline(&DISPATCHER, bodies, self.colliders, filter);
        let [a, b] = core.ends_at(pose).map(|end| end.as_vec3());
        let inside = Capsule::new(a, b, (core.radius * SWEPT) as f32);
        let options = ShapeCastOptions {
            stop_at_penetration: false,
            ..ShapeCastOptions::with_max_time_of_impact(1.0)
        };
        let (_, hit) = world.cast_shape(&Pose::IDENTITY, shift.as_vec3(), &inside, options)?;
        Some(f64::from(hit.time_of_impact))
    }
}

/// The body that a skin patch's collider is for; `None` for any other collider. `skin` is sorted by the collider's
/// handle.
pub(super) fn owner_in(
    skin: &[(ColliderHandle, RigidBodyHandle)],
    collider: ColliderHandle,
) -> Option<RigidBodyHandle> {
    let key = |(skin, _): &(ColliderHandle, RigidBodyHandle)| skin.into_raw_parts();
    let index = skin.binary_search_by_key(&collider.into_raw_parts(), key);
    Some(skin[index.ok()?].1)
}

/// True if a body touches no skin, and its middle is not inside the creature, after a tick that took it from one pose
/// to the other. `origin` is the world position of rapier's origin, `hits` reused memory. `None` if the body is out of
/// reach.
///
/// All of the body counts, not only its core: rapier would drag a body along by a corner that sticks in the skin.
pub(super) fn is_outside(
    surface: &SkinnedSurface,
    (core, hull): (&InnerCapsule, &Hull),
    poses: [&Pose; 2],
    origin: DVec3,
    hits: &mut Vec<SurfaceHit>,
) -> Option<bool> {
    let world_from_model = surface.world_from_model();
    let ends = core.ends_at(poses[1]).map(|end| origin + end);
    let [a, b] = ends.map(|end| world_from_model.inverse_transform_point_f32(end));
    let radius = (core.radius / world_from_model.scale) as f32;
    let (space, core) = (surface.in_model(), geometry::Capsule::new(a, b, radius)?);
    let touched = space.closest_to_capsule(&core, 0.0).is_some()
        || !hull.is_ball() && hull.may_touch(surface, poses, origin);
    Some(!touched && !is_within(space, (a + b) * 0.5, hits))
}
