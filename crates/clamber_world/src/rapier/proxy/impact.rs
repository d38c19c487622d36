//! What collided with the climber in a step, and what a climber of its mass takes of it.

use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderHandle, ColliderSet, ContactPair, NarrowPhase};

use super::{BELOW, ClimberProxy, ProxyHit};
use crate::rapier::BodyPoses;
use crate::rapier::push::{coupling, response};
use crate::rapier::terrain::{key_of, pose_of};
use crate::{MaterialPoint, ProxyBody};

/// The contacts of one body with the climber.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impact {
    body: RigidBodyHandle,
    /// The collider with the strongest of them.
    collider: ColliderHandle,
    /// Rapier's impulse there.
    strongest: f64,
    /// Sums over the contacts, weighed by their impulses: the impulses, the points in rapier's space, and the normals
    /// from the climber to the body.
    weight: f64,
    point: DVec3,
    normal: DVec3,
}

impl Impact {
    fn key(&self) -> ((u32, u32), (u32, u32)) {
        (self.body.into_raw_parts(), self.collider.into_raw_parts())
    }
}

/// How a body and the climber met, along the normal from the climber to the body.
struct Meeting {
    /// The share of the approach that the body has brought; the climber's own motion brought the rest.
    share: f64,
    /// How much of the velocity that the body would have without the climber rapier took, metres a second.
    taken: f64,
    /// The part of it that forces press into the climber in every step.
    pressed: f64,
    /// How much an immovable climber would take of what the body has brought, metres a second.
    brought: f64,
}

impl ClimberProxy {
    pub(super) fn take_impacts(
        &mut self,
        before: &BodyPoses,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        narrow_phase: &NarrowPhase,
        dt: f64,
    ) -> Option<ProxyHit> {
        let mut found = std::mem::take(&mut self.found);
        found.clear();
        for pair in narrow_phase.contact_pairs_with(self.collider) {
            found.extend(self.contacts_of(pair, bodies, colliders));
        }
        found.sort_unstable_by_key(Impact::key);
        found.dedup_by(|next, first| {
            let is_same = next.body == first.body;
            if is_same {
                first.weight += next.weight;
                first.point += next.point;
                first.normal += next.normal;
                if next.strongest > first.strongest {
                    (first.collider, first.strongest) = (next.collider, next.strongest);
                }
            }
            is_same
        });
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

    /// The contacts of one collider with the climber; `None` if they do not touch, or it is not of a dynamic body.
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
        let mut impact = Impact {
            body,
            collider,
            strongest: 0.0,
            weight: 0.0,
            point: DVec3::ZERO,
            normal: DVec3::ZERO,
        };
        let mut add = |weighed: &dyn Fn(f64, f64) -> f64| {
            for manifold in pair.manifolds() {
                let normal = manifold.data.normal.as_dvec3();
                let normal = if is_first { normal } else { -normal };
                for contact in &manifold.points {
                    let weight = weighed(contact.data.impulse.into(), contact.dist.into());
                    let local = if is_first {
                        contact.local_p1
                    } else {
                        contact.local_p2
                    };
                    impact.weight += weight;
                    impact.point += place.transform(local.as_dvec3()) * weight;
                    impact.normal += normal * weight;
                }
            }
            impact.weight
        };
        // A body that rapier has pushed out is on its way in the last of rapier's substeps, which has no impulse.
        if add(&|impulse, _| impulse.max(0.0)) <= 0.0 {
            add(&|_, distance| (-distance).max(0.0));
        }
        impact.strongest = impact.weight;
        (impact.weight > 0.0).then_some(impact)
    }

    /// Gives back to a body what the climber does not take, and adds what it takes to the hit.
    fn weigh(
        &self,
        impact: &Impact,
        (before, dt): (&BodyPoses, f64),
        bodies: &mut RigidBodySet,
        colliders: &ColliderSet,
        hit: &mut Option<(f64, ProxyHit)>,
    ) -> Option<()> {
        let normal = impact.normal.try_normalize()?;
        let point = impact.point / impact.weight;
        let [linvel, angvel] = before.velocities(impact.body)?.map(|v| v.as_dvec3());
        let body = bodies.get_mut(impact.body)?;
        let arm = point - body.mass_properties().world_com.as_dvec3();
        let was = linvel + angvel.cross(arm);
        let is = super::velocity_at(body, point);
        let free = was + acceleration(body) * dt;
        let meeting = meeting(&self.body, [was, free, is], normal);
        let response = response(body, point, normal);
        let whole = meeting.taken / response;
        if !whole.is_finite() {
            return None;
        }
        let own = 1.0 - meeting.share;
        if own > 0.0 {
            // The climber ran into it, which its own pushes account for: it stays where it would be.
            let from = pose_of(before.get(impact.body)?);
            let local = pose_of(body.position()).inverse_transform(point);
            let moved = (point - from.transform(local)).dot(normal);
            let shoved = (moved - free.dot(normal) * dt).max(0.0) * own;
            body.set_translation(body.translation() - (normal * shoved).as_vec3(), true);
        }
        let is_felt = meeting.taken > meeting.pressed && meeting.brought > self.body.gentle;
        let felt = meeting.brought / (response + mobility(&self.body, normal) / self.body.mass);
        let kept = if is_felt {
            felt + meeting.pressed * meeting.share / response
        } else {
            // Too slow to be felt: it rests on the climber.
            whole * meeting.share
        };
        // What leaves the climber on its own takes that along.
        let correction = normal
            * if meeting.taken > 0.0 {
                kept - whole
            } else {
                0.0
            };
        if correction != DVec3::ZERO {
            let slip = (self.body.drift - free).reject_from_normalized(normal);
            let friction = friction(body, point, is - free, slip, normal * whole);
            let most = whole * self.friction_with(impact.collider, colliders);
            let back = friction.clamp_length_max(most) * (1.0 - kept / whole).max(0.0);
            let impulse = correction - back;
            body.apply_impulse_at_point(impulse.as_vec3(), point.as_vec3(), true);
        }
        if is_felt {
            let collider = colliders.get(impact.collider)?;
            let local = pose_of(collider.position()).inverse_transform(point);
            let this = ProxyHit {
                impulse: normal * -felt,
                material: MaterialPoint {
                    key: key_of(impact.collider),
                    coordinates: local.to_array(),
                },
                point: point + self.origin,
            };
            *hit = Some(match hit.take() {
                Some((most, other)) => {
                    let impulse = this.impulse + other.impulse;
                    let hardest = if felt > most { this } else { other };
                    (most.max(felt), ProxyHit { impulse, ..hardest })
                }
                None => (felt, this),
            });
        }
        Some(())
    }

    /// An upper bound of the coefficient of friction between the proxy and a collider.
    fn friction_with(&self, other: ColliderHandle, colliders: &ColliderSet) -> f64 {
        let of = |handle| colliders.get(handle).map_or(0.0, |collider| collider.friction());
        of(self.collider).max(of(other)).into()
    }
}

/// The impulse of rapier's friction on a body's point: of the change of its velocity, what follows the climber's slip
/// along it and does not come from the normal impulse.
fn friction(body: &RigidBody, point: DVec3, change: DVec3, slip: DVec3, normal: DVec3) -> DVec3 {
    let Some(along) = slip.try_normalize() else {
        return DVec3::ZERO;
    };
    let dragged = change.dot(along) - coupling(body, point, along, normal);
    let impulse = dragged / response(body, point, along);
    if impulse > 0.0 && impulse.is_finite() {
        along * impulse
    } else {
        DVec3::ZERO
    }
}

/// Acceleration of a body by gravity and the forces of its game in rapier's last step, metres per square second. Rapier
/// tells where it would be in a second with them and without.
fn acceleration(body: &RigidBody) -> DVec3 {
    let center = body.mass_properties().local_mprops.local_com;
    let forced = body.predict_position_using_velocity_and_forces(1.0) * center;
    let unforced = body.predict_position_using_velocity(1.0) * center;
    (forced - unforced).as_dvec3()
}

/// How a body met the climber. Its velocity at the contact was one before the step, would be another without the
/// climber, and is a third.
fn meeting(climber: &ProxyBody, [was, free, is]: [DVec3; 3], normal: DVec3) -> Meeting {
    let (taken, changed) = ((is - free).dot(normal), (is - was).dot(normal));
    let closing = |velocity: DVec3| (velocity - free).dot(normal);
    let at_proxy = closing(climber.drift);
    let by_body = closing(climber.frame_velocity).min(closing(climber.velocity));
    // It lands on what is below it by its own rules. And what overlaps the layer around it because of its own motion is
    // not pushed out.
    let is_below = normal.dot(climber.up) < -BELOW;
    let share = if is_below || at_proxy <= 0.0 {
        0.0
    } else {
        (by_body / at_proxy).clamp(0.0, 1.0)
    };
    // Where a gap is left, rapier takes a part only, and the rest in the next step. An impact is weighed as a whole.
    let whole = changed.max((climber.drift - was).dot(normal));
    Meeting {
        share,
        taken,
        pressed: (taken - changed).max(0.0),
        brought: whole * share,
    }
}

/// The share of the climber's mobility that its support leaves it along a normal, away from the body: 0 straight into
/// the support.
fn mobility(climber: &ProxyBody, normal: DVec3) -> f64 {
    let into = climber
        .support_normal
        .map_or(0.0, |support| normal.dot(support).max(0.0));
    (1.0 - into * into).max(0.0)
}
