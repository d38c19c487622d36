//! A climber as a kinematic body of a rapier world.
//!
//! Rapier's solver treats kinematic bodies as infinitely heavy. So it stops every body that meets the proxy, and
//! afterwards [`ClimberProxy::after_step`] gives back the impulse that a climber of its mass would not have taken, by
//! [`ProxyBody::share`].
//!
//! A body that is fast enough to enter the climber between two of rapier's detections is put back along its own path to
//! where it first touched the climber, and collides in the next step. This is the motion clamping of continuous
//! collision detection, in the climber's frame.

mod clamp;
mod impact;

use glam::DVec3;
use rapier3d::dynamics::{
    GenericJointBuilder, ImpulseJointHandle, ImpulseJointSet, JointAxesMask, RigidBody,
    RigidBodyBuilder, RigidBodyHandle, RigidBodySet,
};
use rapier3d::geometry::{
    Collider, ColliderBuilder, ColliderHandle, ColliderSet, NarrowPhase, SharedShape,
};
use rapier3d::math::{Pose, Vector};
use rapier3d::pipeline::{ActiveHooks, PhysicsWorld};

use super::{BodyPoses, RapierTerrain};
use crate::{MaterialPoint, ProxyBody, ProxyTouch};

/// Hooks that make rapier compute the proxy's contacts in every step. For colliders without hooks, rapier reuses the
/// contacts of two bodies that hardly moved, and does not see that a joint has disabled them since. This hook is only
/// called for sensors, and a proxy is no sensor.
const FRESH: ActiveHooks = ActiveHooks::FILTER_INTERSECTION_PAIR;

/// A climber's kinematic body in a rapier world: dynamic bodies collide with it, rest on it and strike it.
///
/// Each tick, in this order: record poses, step rapier, [`after_step`](Self::after_step), step the climber with the
/// blow and without the proxy's own collider among its obstacles, apply its pushes, [`follow`](Self::follow).
///
/// ```
/// use clamber_world::rapier3d::prelude::*;
/// use clamber_world::{BodyPoses, ClimberProxy, ProxyBody, RapierTerrain, WorldCapsule};
/// use glam::DVec3;
///
/// let mut world = PhysicsWorld::default();
/// world.insert(
///     RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 2.0, 0.0)),
///     ColliderBuilder::cuboid(0.3, 0.3, 0.3).mass(20.0),
/// );
/// // `Climber::proxy_body` makes this.
/// let body = ProxyBody {
///     capsule: WorldCapsule::ball(DVec3::ZERO, 0.4),
///     margin: 0.01,
///     mass: 80.0,
///     velocity: DVec3::ZERO,
///     drift: DVec3::ZERO,
///     frame_velocity: DVec3::ZERO,
///     up: DVec3::Y,
///     support_normal: Some(DVec3::Y),
///     gentle: 0.01,
///     support: None,
/// };
/// let mut proxy = ClimberProxy::insert(&body, DVec3::ZERO, &mut world.bodies, &mut world.colliders);
/// let mut before = BodyPoses::new();
/// let mut impulse = 0.0;
/// for _ in 0..60 {
///     before.record(&world.bodies);
///     world.step();
///     let hit = proxy.after_step(&before, &mut world.bodies, &mut world.colliders, &world.narrow_phase, 1.0 / 60.0);
///     impulse += hit.map_or(0.0, |hit| hit.impulse.length());
///     let seen = |handle, _: &Collider| handle != proxy.collider();
///     let _terrain = RapierTerrain::of_world(&world, &before).with_filter(&seen);
///     // Here the climber is stepped.
///     proxy.follow(&body, [], &mut world.bodies, &mut world.colliders, &mut world.impulse_joints);
/// }
/// // 20 kg that fell by 1.3 m: 5 m/s.
/// assert!((impulse / 20.0 - 5.0).abs() < 0.2, "{impulse}");
/// ```
///
/// The proxy does not collide with the body that carries the climber, nor with bodies that the climber walks into: the
/// climber itself gives them its weight and its pushes. Such pairs are joined by a joint that locks no axis and
/// disables contacts. Static and kinematic bodies do not collide with the proxy either, because in rapier kinematic
/// bodies collide with dynamic ones only.
///
/// All state is in the world and in this value. If you save both between two ticks, with the climber's state, and
/// restore them, they go on with the same bits. [`DebrisSnapshot`](crate::DebrisSnapshot) saves a world.
///
/// Without a filter, the climber would touch its own proxy. Leave the proxies of all climbers out, because climbers see
/// each other as obstacles of their own.
#[derive(Clone, Debug)]
pub struct ClimberProxy {
    handle: RigidBodyHandle,
    collider: ColliderHandle,
    /// World position of rapier's origin.
    origin: DVec3,
    /// The climber as it was followed last.
    body: ProxyBody,
    /// Bodies that the proxy does not collide with, ascending, and the joints that disable their contacts.
    apart: Vec<(RigidBodyHandle, ImpulseJointHandle)>,
    /// Reused by [`ClimberProxy::follow`].
    wanted: Vec<RigidBodyHandle>,
    /// Reused by [`ClimberProxy::after_step`].
    found: Vec<impact::Impact>,
    clamped: Vec<(RigidBodyHandle, Pose)>,
}

/// The impact on a climber in a step of rapier.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProxyImpulse {
    /// The impulse that the climber gets, newton seconds, in world space; the sum, if several bodies struck it.
    pub impulse: DVec3,
    /// The point of rapier's world that struck the climber hardest.
    pub material: MaterialPoint,
    /// Position of that point, in world space.
    pub point: DVec3,
}

impl ClimberProxy {
    /// Inserts the kinematic body of a climber. `origin` is the world position of rapier's origin, as in
    /// [`RapierTerrain::with_origin`].
    pub fn insert(
        body: &ProxyBody,
        origin: DVec3,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Self {
        let place = (body.capsule.ends[0] - origin).as_vec3();
        let kinematic = RigidBodyBuilder::kinematic_velocity_based()
            .translation(place)
            .linvel(body.drift.as_vec3());
        let handle = bodies.insert(kinematic);
        let collider = ColliderBuilder::new(shape(body))
            .friction(ProxyBody::FRICTION)
            .active_hooks(FRESH)
            .mass(body.mass as f32);
        let collider = colliders.insert_with_parent(collider, handle, bodies);
        Self {
            handle,
            collider,
            origin,
            body: *body,
            apart: Vec::new(),
            wanted: Vec::new(),
            found: Vec::new(),
            clamped: Vec::new(),
        }
    }

    /// Removes the body, its collider and its joints. If your world keeps rapier's sets separately, remove
    /// [`body`](Self::body) from them instead.
    pub fn remove(self, world: &mut PhysicsWorld) {
        world.remove_body(self.handle);
    }

    /// The proxy's collider. Leave it out of the climber's own queries with [`RapierTerrain::with_filter`]. Its
    /// friction, restitution and collision groups may be changed.
    pub fn collider(&self) -> ColliderHandle {
        self.collider
    }

    /// The proxy's rigid body.
    pub fn body(&self) -> RigidBodyHandle {
        self.handle
    }

    /// Sets the world position of rapier's origin, for a game that moves it.
    pub fn set_origin(&mut self, origin: DVec3) {
        self.origin = origin;
    }

    /// Follows the climber: call it after the climber's step, and before the next step of rapier. `touched` has the
    /// climber's contacts in this world (`Climber::proxy_touches`).
    ///
    /// Does nothing if a number of the body is not finite, or if the proxy was removed from the world.
    pub fn follow(
        &mut self,
        body: &ProxyBody,
        touched: impl IntoIterator<Item = ProxyTouch>,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        joints: &mut ImpulseJointSet,
    ) {
        let place = (body.capsule.ends[0] - self.origin).as_vec3();
        let drift = body.drift.as_vec3();
        let is_sound = place.is_finite() && drift.is_finite() && body.capsule.is_valid();
        let Some(kinematic) = bodies.get_mut(self.handle).filter(|_| is_sound) else {
            return;
        };
        kinematic.set_translation(place, true);
        kinematic.set_linvel(drift, true);
        if let Some(collider) = colliders.get_mut(self.collider) {
            if axis(body) != axis(&self.body)
                || body.capsule.radius != self.body.capsule.radius
                || body.margin != self.body.margin
            {
                collider.set_shape(shape(body));
            }
            if body.mass != self.body.mass {
                collider.set_mass(body.mass as f32);
            }
        }
        self.body = *body;
        self.keep_apart(touched, bodies, colliders, joints);
    }

    /// Lets the proxy collide with all bodies but those that the climber stands on, holds or walks into.
    fn keep_apart(
        &mut self,
        touched: impl IntoIterator<Item = ProxyTouch>,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        joints: &mut ImpulseJointSet,
    ) {
        let rigid_body_id = |material: &MaterialPoint| {
            let collider = colliders.get(RapierTerrain::collider_of(material))?;
            let handle = collider.parent()?;
            let body = bodies.get(handle).filter(|body| body.is_dynamic())?;
            Some((handle, body))
        };
        self.wanted.clear();
        let support = self.body.support.as_ref().and_then(rigid_body_id);
        self.wanted.extend(support.map(|(handle, _)| handle));
        for touch in touched {
            let Some((handle, body)) = rigid_body_id(&touch.material) else {
                continue;
            };
            let velocity = velocity_at(body, touch.position - self.origin);
            if self.body.pushes_by_itself(&touch, velocity) {
                self.wanted.push(handle);
            }
        }
        self.wanted
            .sort_unstable_by_key(|handle| handle.into_raw_parts());
        self.wanted.dedup();
        let (own, wanted) = (self.handle, &self.wanted);
        self.apart.retain(|(handle, joint)| {
            let stays = wanted.contains(handle) && joints.get(*joint).is_some();
            if !stays {
                joints.remove(*joint, false);
            }
            stays
        });
        for handle in wanted {
            if self.apart.iter().all(|(known, _)| known != handle) {
                let free = GenericJointBuilder::new(JointAxesMask::empty()).contacts_enabled(false);
                self.apart
                    .push((*handle, joints.insert(own, *handle, free, false)));
            }
        }
        self.apart
            .sort_unstable_by_key(|(handle, _)| handle.into_raw_parts());
    }

    /// Shares the impacts of rapier's last step by mass: gives back to each body the impulse that the climber does not
    /// take, and puts bodies that entered the climber back to where they first touched it. Returns the impact on the
    /// climber, for `Climber::knockback_of`; `None` if no body struck it.
    ///
    /// `before` holds the bodies as they were recorded right before the step. `dt` is the length of the tick, seconds.
    pub fn after_step(
        &mut self,
        before: &BodyPoses,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        narrow_phase: &NarrowPhase,
        dt: f64,
    ) -> Option<ProxyImpulse> {
        let hit = self.take_impacts(before, bodies, colliders, narrow_phase, dt);
        self.clamp(before, bodies, colliders, dt);
        hit
    }

    fn is_apart(&self, body: RigidBodyHandle) -> bool {
        self.apart.iter().any(|(known, _)| *known == body)
    }
}

/// Vector from one end of the capsule to the other, in rapier's numbers.
fn axis(body: &ProxyBody) -> Vector {
    (body.capsule.ends[1] - body.capsule.ends[0]).as_vec3()
}

/// The shape that bodies touch, relative to the capsule's first end: the climber's body with a layer around it.
fn shape(body: &ProxyBody) -> SharedShape {
    let radius = (body.capsule.radius + body.margin) as f32;
    let axis = axis(body);
    if axis == Vector::ZERO {
        SharedShape::ball(radius)
    } else {
        SharedShape::capsule(Vector::ZERO, axis, radius)
    }
}

/// Velocity of a body's point, in rapier's space.
fn velocity_at(body: &RigidBody, point: DVec3) -> DVec3 {
    let arm = point - body.mass_properties().world_com.as_dvec3();
    body.linvel().as_dvec3() + body.angvel().as_dvec3().cross(arm)
}

/// True for a collider that bodies collide with: it is enabled and not a sensor.
fn is_solid(collider: &Collider) -> bool {
    collider.is_enabled() && !collider.is_sensor()
}
