use avian3d::collision::contact_types::ContactGraph;
use avian3d::dynamics::integrator::VelocityIntegrationData;
use avian3d::dynamics::rigid_body::{RigidBodyQuery, RigidBodyQueryItem};
use avian3d::prelude::{
    AngularVelocity, ComputedCenterOfMass, LinearVelocity, Physics, PhysicsTime, Position,
    RigidBody, Rotation, Sleeping, SubstepCount,
};
use bevy_ecs::prelude::*;
use bevy_time::Time;
use clamber_world::{ProxyMeeting, RigidPose};
use glam::DVec3;

use super::impact::{Impact, Recorded, impact_of, other};
use super::{AvianProxies, AvianProxy};
use crate::{ClimberBlow, ClimberBody, ClimberInput};

/// A penetration, metres, at which avian lets go of a contact, since it takes it for one that is far away.
const FAR: f32 = -1e9;

/// Drops the contacts with bodies with which climbers do not collide.
pub(super) fn keep_apart(mut all: ResMut<AvianProxies>, mut graph: ResMut<ContactGraph>) {
    let AvianProxies {
        proxies, contacts, ..
    } = &mut *all;
    for proxy in proxies.values().filter(|proxy| !proxy.apart.is_empty()) {
        contacts.clear();
        contacts.extend(graph.contact_edges_with(proxy.body).map(|edge| edge.id));
        for id in contacts.iter() {
            let Some((_, pair)) = graph.get_mut_by_id(*id) else {
                continue;
            };
            if other(pair, proxy.body).is_some_and(|(body, _)| proxy.apart.contains(&body)) {
                for contact in pair.manifolds.iter_mut().flat_map(|all| &mut all.points) {
                    contact.penetration = FAR;
                    contact.warm_start_normal_impulse = 0.0;
                    contact.warm_start_tangent_impulse = Default::default();
                }
            }
        }
    }
}

type Unsolved = (
    &'static RigidBody,
    &'static Position,
    &'static Rotation,
    &'static LinearVelocity,
    &'static AngularVelocity,
    &'static VelocityIntegrationData,
    &'static ComputedCenterOfMass,
);

/// Records the bodies that can strike climbers.
pub(super) fn record(
    mut all: ResMut<AvianProxies>,
    substeps: Res<SubstepCount>,
    bodies: Query<(Entity, Unsolved), Without<Sleeping>>,
) {
    let AvianProxies {
        proxies, recorded, ..
    } = &mut *all;
    recorded.clear();
    if proxies.is_empty() {
        return;
    }
    for (body, (kind, position, rotation, linear, angular, data, center)) in &bodies {
        if kind.is_dynamic() {
            let pose = RigidPose::new(rotation.0, position.0);
            recorded.push(Recorded {
                body,
                pose,
                center: pose.transform(center.0.as_dvec3()),
                linear: linear.0,
                angular: angular.0,
                gained: data.linear_increment * substeps.0 as f32,
            });
        }
    }
    recorded.sort_unstable_by_key(|recorded| recorded.body);
}

/// Weighs what collided with climbers, and strikes these.
pub(super) fn strike(
    mut climbers: Query<(&ClimberBody, &mut ClimberInput), With<AvianProxy>>,
    mut all: ResMut<AvianProxies>,
    graph: Res<ContactGraph>,
    mut bodies: Query<RigidBodyQuery>,
    time: Res<Time<Physics>>,
) {
    let AvianProxies {
        proxies,
        recorded,
        impacts,
        ..
    } = &mut *all;
    let dt = time.delta_secs_f64();
    if time.is_paused() || dt <= 0.0 {
        return;
    }
    for (climber, proxy) in proxies {
        impacts.clear();
        let pairs = graph.contact_pairs_with(proxy.body);
        impacts.extend(pairs.filter_map(|pair| impact_of(pair, proxy.body)));
        Impact::merge(impacts);
        let mut hit: Option<(DVec3, f64, Entity)> = None;
        for impact in impacts
            .iter()
            .filter(|impact| !proxy.apart.contains(&impact.body))
        {
            let before = Recorded::find(recorded, impact.body);
            let (Some(before), Ok(mut body)) = (before, bodies.get_mut(impact.body)) else {
                continue;
            };
            let Some(meeting) = meeting(impact, before, &body, dt) else {
                continue;
            };
            let point = impact.point();
            let respond = |impulse| response(&body, point, impulse);
            let Some(share) = proxy.shown.share(&meeting, respond) else {
                continue;
            };
            let turned = turn(&body, point, share.body);
            // Otherwise avian takes it for moved by the game, and its transform for old.
            if share.shift != DVec3::ZERO {
                body.position.bypass_change_detection().0 += share.shift.as_vec3();
            }
            if share.body != DVec3::ZERO {
                let pushed = body.effective_inverse_mass().as_dvec3() * share.body;
                body.linear_velocity.0 += pushed.as_vec3();
                body.angular_velocity.0 += turned.as_vec3();
            }
            if let Some(impulse) = share.climber {
                let hardness = impulse.length();
                hit = Some(
                    hit.map_or((impulse, hardness, impact.collider), |(sum, most, by)| {
                        let by = if hardness > most { impact.collider } else { by };
                        (sum + impulse, most.max(hardness), by)
                    }),
                );
            }
        }
        let (Some((impulse, _, by)), Ok((body, mut input))) = (hit, climbers.get_mut(*climber))
        else {
            continue;
        };
        if let Some(blow) = body.climber().knockback_of(impulse, None) {
            input.strike(ClimberBlow {
                velocity: blow.velocity.as_vec3(),
                damage: blow.damage as f32,
                by: Some(by),
            });
        }
    }
}

fn meeting(
    impact: &Impact,
    before: &Recorded,
    body: &RigidBodyQueryItem,
    dt: f64,
) -> Option<ProxyMeeting> {
    let point = impact.point();
    let arm = point - center_of(body);
    let was = before.velocity_at(point);
    let is = body.linear_velocity.0.as_dvec3() + body.angular_velocity.0.as_dvec3().cross(arm);
    let free = was + before.gained.as_dvec3();
    let from = before
        .pose
        .transform(pose_of(body).inverse_transform(point));
    Some(ProxyMeeting {
        normal: impact.normal()?,
        before: was,
        free,
        after: is,
        shifted: point - from - free * dt,
        friction: impact.friction(),
    })
}

fn pose_of(body: &RigidBodyQueryItem) -> RigidPose {
    RigidPose::new(body.rotation.0, body.position.0)
}

fn center_of(body: &RigidBodyQueryItem) -> DVec3 {
    pose_of(body).transform(body.center_of_mass.0.as_dvec3())
}

/// Change of a body's angular velocity for an impulse at a point.
fn turn(body: &RigidBodyQueryItem, point: DVec3, impulse: DVec3) -> DVec3 {
    let torque = (point - center_of(body)).cross(impulse).as_vec3();
    (body.effective_global_angular_inertia().inverse() * torque).as_dvec3()
}

/// Change of the velocity of a body's point for an impulse there.
fn response(body: &RigidBodyQueryItem, point: DVec3, impulse: DVec3) -> DVec3 {
    let slide = body.effective_inverse_mass().as_dvec3() * impulse;
    slide + turn(body, point, impulse).cross(point - center_of(body))
}
