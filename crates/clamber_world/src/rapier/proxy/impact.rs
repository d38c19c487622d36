//! The impacts of bodies on the climber in a step, and the share of each that a climber of its mass takes.

use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderHandle, ColliderSet, ContactPair, NarrowPhase};

use super::{ClimberProxy, ProxyImpulse};
use crate::rapier::BodyPoses;
use crate::rapier::push::point_response;
use crate::rapier::terrain::{key_of, pose_of};
use crate::{MaterialPoint, ProxyImpact, ProxyMeeting};

/// An impact. Bodies and colliders are named by index and generation.
pub(super) type Impact = ProxyImpact<(u32, u32), (u32, u32)>;

impl ClimberProxy {
    pub(super) fn take_impacts(
        &mut self,
        before: &BodyPoses,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        narrow_phase: &NarrowPhase,
        dt: f64,
    ) -> Option<ProxyImpulse> {
        let mut found = std::mem::take(&mut self.found);
        found.clear();
        for pair in narrow_phase.contact_pairs_with(self.collider) {
            found.extend(self.contacts_of(pair, bodies, colliders));
        }
        Impact::merge(&mut found);
        let mut hit = None;
        for impact in &found {
            self.weigh(impact, (before, dt), bodies, colliders, &mut hit);
        }
        if !found.is_empty() {
            bodies.propagate_modified_body_positions_to_colliders(colliders);
        }
        self.found = found;
        hit.map(|(_, hit)| hit)
    }

    /// The contacts of one collider with the climber; `None` if they do not touch, or if its body is not dynamic.
    fn contacts_of(
        &self,
        pair: &ContactPair,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
    ) -> Option<Impact> {
        let is_first = pair.collider1 == self.collider;
        let collider = if is_first {
            pair.collider2
        } else {
            pair.collider1
        };
        let body = colliders.get(collider)?.parent()?;
        bodies.get(body).filter(|body| body.is_dynamic())?;
        let place = pose_of(bodies.get(self.handle)?.position());
        let mut impact = Impact::new(body.into_raw_parts(), collider.into_raw_parts());
        let friction = self.friction_with(collider, colliders);
        let mut add = |weigh: &dyn Fn(f64, f64) -> f64| {
            for manifold in pair.manifolds() {
                let normal = manifold.data.normal.as_dvec3();
                let normal = if is_first { normal } else { -normal };
                for contact in &manifold.points {
                    let weight = weigh(contact.data.impulse.into(), contact.dist.into());
                    let local = if is_first {
                        contact.local_p1
                    } else {
                        contact.local_p2
                    };
                    impact.add(weight, place.transform(local.as_dvec3()), normal, friction);
                }
            }
            impact.touches()
        };
        // A body that rapier has pushed out already leaves in the last of rapier's substeps, so its contacts there have
        // no impulse. Then their depths are the weights.
        let touches =
            add(&|impulse, _| impulse.max(0.0)) || add(&|_, distance| (-distance).max(0.0));
        touches.then_some(impact)
    }

    /// Shares an impact: gives back to the body the impulse that the climber does not take, and adds the climber's
    /// impulse to the hit.
    fn weigh(
        &self,
        impact: &Impact,
        (before, dt): (&BodyPoses, f64),
        bodies: &mut RigidBodySet,
        colliders: &ColliderSet,
        hit: &mut Option<(f64, ProxyImpulse)>,
    ) -> Option<()> {
        let normal = impact.normal()?;
        let point = impact.point();
        let handle = RigidBodyHandle::from_raw_parts(impact.body.0, impact.body.1);
        let collider = ColliderHandle::from_raw_parts(impact.collider.0, impact.collider.1);
        let [linvel, angvel] = before.velocities(handle)?.map(|v| v.as_dvec3());
        let body = bodies.get_mut(handle)?;
        let arm = point - body.mass_properties().world_com.as_dvec3();
        let was = linvel + angvel.cross(arm);
        let free = was + acceleration(body) * dt;
        let local = pose_of(body.position()).inverse_transform(point);
        let from = pose_of(before.get(handle)?).transform(local);
        let meeting = ProxyMeeting {
            normal,
            before: was,
            free,
            after: super::velocity_at(body, point),
            shifted: point - from - free * dt,
            friction: impact.friction(),
        };
        let share = self
            .body
            .share(&meeting, |impulse| point_response(body, point, impulse))?;
        if share.shift != DVec3::ZERO {
            body.set_translation(body.translation() + share.shift.as_vec3(), true);
        }
        if share.body != DVec3::ZERO {
            body.apply_impulse_at_point(share.body.as_vec3(), point.as_vec3(), true);
        }
        if let Some(impulse) = share.climber {
            let local = pose_of(colliders.get(collider)?.position()).inverse_transform(point);
            let this = ProxyImpulse {
                impulse,
                material: MaterialPoint {
                    key: key_of(collider),
                    coordinates: local.to_array(),
                },
                point: point + self.origin,
            };
            let hardness = impulse.length();
            *hit = Some(match hit.take() {
                Some((most, other)) => {
                    let impulse = this.impulse + other.impulse;
                    let hardest = if hardness > most { this } else { other };
                    (most.max(hardness), ProxyImpulse { impulse, ..hardest })
                }
                None => (hardness, this),
            });
        }
        Some(())
    }

    /// An upper bound of the coefficient of friction between the proxy and a collider.
    fn friction_with(&self, other: ColliderHandle, colliders: &ColliderSet) -> f64 {
        let of = |handle| {
            colliders
                .get(handle)
                .map_or(0.0, |collider| collider.friction())
        };
        of(self.collider).max(of(other)).into()
    }
}

/// Acceleration of a body by gravity and the forces of its game in rapier's last step, metres per square second: the
/// difference between rapier's predictions of its place in a second with forces and without.
fn acceleration(body: &RigidBody) -> DVec3 {
    let center = body.mass_properties().local_mprops.local_com;
    let forced = body.predict_position_using_velocity_and_forces(1.0) * center;
    let unforced = body.predict_position_using_velocity(1.0) * center;
    (forced - unforced).as_dvec3()
}
