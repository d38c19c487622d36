//! What collided with the climber in a step, and what a climber of its mass takes of it.

use glam::DVec3;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{ColliderHandle, ColliderSet, ContactPair, NarrowPhase};

use super::{BELOW, ClimberProxy, ProxyHit};
use crate::rapier::BodyPoses;
use crate::rapier::push::response;
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
    /// How much of the body's velocity rapier took, metres a second.
    taken: f64,
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
        let meeting = meeting(&self.body, was, is, normal);
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
            let shoved = (moved - was.dot(normal) * dt).max(0.0) * own;
            body.set_translation(body.translation() - (normal * shoved).as_vec3(), true);
        }
        let is_felt = meeting.taken > 0.0 && meeting.brought > self.body.gentle;
        let kept = if is_felt {
            meeting.brought / (response + mobility(&self.body, normal) / self.body.mass)
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
            body.apply_impulse_at_point(correction.as_vec3(), point.as_vec3(), true);
        }
        if is_felt {
            let collider = colliders.get(impact.collider)?;
            let local = pose_of(collider.position()).inverse_transform(point);
            let this = ProxyHit {
                impulse: normal * -kept,
                material: MaterialPoint {
                    key: key_of(impact.collider),
                    coordinates: local.to_array(),
                },
                point: point + self.origin,
            };
            *hit = Some(match hit.take() {
                Some((most, other)) => {
                    let impulse = this.impulse + other.impulse;
                    let hardest = if kept > most { this } else { other };
                    (most.max(kept), ProxyHit { impulse, ..hardest })
                }
                None => (kept, this),
            });
        }
        Some(())
    }
}

/// How a body whose velocity changed at the contact met the climber.
fn meeting(climber: &ProxyBody, was: DVec3, is: DVec3, normal: DVec3) -> Meeting {
    let taken = (is - was).dot(normal);
    let closing = |velocity: DVec3| (velocity - was).dot(normal);
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
    let whole = taken.max(at_proxy);
    Meeting {
        share,
        taken,
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
