use avian3d::prelude::{
    AngularVelocity, Collider, ColliderOf, ComputedCenterOfMass, Friction, LinearVelocity,
    Position, RigidBody, Rotation,
};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_transform::components::Transform;
use clamber_world::{MaterialPoint, ProxyBody, RigidPose};
use glam::{DVec3, Vec3};

use super::{AvianProxies, AvianProxy, Proxy, StandIn};
use crate::climber::AVIAN;
use crate::{ClimberBody, WorldOrigin};

type Moving = (
    &'static RigidBody,
    &'static Position,
    &'static Rotation,
    &'static LinearVelocity,
    &'static AngularVelocity,
    &'static ComputedCenterOfMass,
);

/// Reads avian's bodies.
#[derive(SystemParam)]
pub(super) struct Bodies<'w, 's> {
    colliders: Query<'w, 's, &'static ColliderOf>,
    bodies: Query<'w, 's, Moving, Without<StandIn>>,
}

impl Bodies<'_, '_> {
    /// The dynamic body of a material point.
    fn of(&self, point: &MaterialPoint) -> Option<Entity> {
        let collider = Entity::try_from_bits(point.key)?;
        let body = self.colliders.get(collider).ok()?.body;
        let (kind, ..) = self.bodies.get(body).ok()?;
        kind.is_dynamic().then_some(body)
    }

    /// Velocity of a body at a place in avian's space.
    fn velocity_at(&self, body: Entity, place: DVec3) -> DVec3 {
        let Ok((_, position, rotation, linear, angular, center)) = self.bodies.get(body) else {
            return DVec3::ZERO;
        };
        let center = RigidPose::new(rotation.0, position.0).transform(center.0.as_dvec3());
        linear.0.as_dvec3() + angular.0.as_dvec3().cross(place - center)
    }
}

/// Puts the bodies that stand for climbers where these are.
pub(super) fn follow(
    mut commands: Commands,
    mut all: ResMut<AvianProxies>,
    origin: Res<WorldOrigin>,
    climbers: Query<(Entity, &ClimberBody), With<AvianProxy>>,
    mut stand_ins: Query<
        (Entity, &mut Position, &mut LinearVelocity, &mut Collider),
        With<StandIn>,
    >,
    bodies: Bodies,
) {
    let proxies = &mut all.proxies;
    proxies.retain(|climber, _| climbers.contains(*climber));
    // Removes the bodies of climbers that are gone, and the bodies of a saved world.
    for (stand_in, ..) in &stand_ins {
        if proxies.values().all(|proxy| proxy.body != stand_in) {
            commands.entity(stand_in).despawn();
        }
    }
    for (entity, body) in &climbers {
        let climber = body.climber();
        let shown = climber.proxy_body(AVIAN);
        let place = (shown.capsule.ends[0] - origin.0).as_vec3();
        let drift = shown.drift.as_vec3();
        let known = proxies.get_mut(&entity);
        let known = known.and_then(|known| Some((stand_ins.get_mut(known.body).ok()?, known)));
        let Some(((_, mut position, mut velocity, mut collider), known)) = known else {
            let stand_in = spawn(&mut commands, &shown, place, drift);
            let proxy = Proxy {
                body: stand_in,
                shown,
                apart: Vec::new(),
            };
            proxies.insert(entity, proxy);
            continue;
        };
        position.set_if_neq(Position(place));
        velocity.set_if_neq(LinearVelocity(drift));
        if axis(&shown) != axis(&known.shown)
            || shown.capsule.radius != known.shown.capsule.radius
            || shown.margin != known.shown.margin
        {
            *collider = shape(&shown);
        }
        known.shown = shown;
        known.apart.clear();
        let support = shown.support.as_ref().and_then(|on| bodies.of(on));
        known.apart.extend(support);
        for touch in climber.proxy_touches(AVIAN) {
            let pushed = bodies.of(&touch.material).filter(|pushed| {
                let velocity = bodies.velocity_at(*pushed, touch.position - origin.0);
                shown.pushes_by_itself(&touch, velocity)
            });
            known.apart.extend(pushed);
        }
    }
}

fn spawn(commands: &mut Commands, shown: &ProxyBody, place: Vec3, drift: Vec3) -> Entity {
    let stand_in = (
        StandIn,
        RigidBody::Kinematic,
        shape(shown),
        Friction::new(ProxyBody::FRICTION),
        Transform::from_translation(place),
        Position(place),
        LinearVelocity(drift),
    );
    commands.spawn(stand_in).id()
}

/// From one end of the capsule to the other, in avian's numbers.
fn axis(body: &ProxyBody) -> Vec3 {
    (body.capsule.ends[1] - body.capsule.ends[0]).as_vec3()
}

/// The shape that bodies touch, from the capsule's first end: the climber's body with a layer around it.
fn shape(body: &ProxyBody) -> Collider {
    let radius = (body.capsule.radius + body.margin) as f32;
    let axis = axis(body);
    if axis == Vec3::ZERO {
        Collider::sphere(radius)
    } else {
        Collider::capsule_endpoints(radius, Vec3::ZERO, axis)
    }
}
