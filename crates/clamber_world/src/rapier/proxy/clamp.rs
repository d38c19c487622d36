//! Bodies that entered the climber during a step.

use clamber_surface::geometry::slerp;
use glam::DVec3;
use rapier3d::dynamics::{RigidBody, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::math::{Pose, Rotation};

use super::{ClimberProxy, is_solid};
use crate::rapier::BodyPoses;
use crate::rapier::terrain::pose_of;
use crate::shapes::{FirstContact, Moved, overlap_shape};
use crate::{RigidPose, SweepContact, WorldCapsule};

/// A body is stopped in this share of the layer around the climber. It then overlaps the proxy, so that rapier's next
/// step finds the contact; and it is above the depth to which rapier lets resting bodies overlap.
const STOPS: f64 = 0.4;

impl ClimberProxy {
    /// Puts each body that entered the climber by its own motion back to where it touched it first.
    pub(super) fn clamp(
        &mut self,
        before: &BodyPoses,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        dt: f64,
    ) {
        let capsule = WorldCapsule {
            radius: self.body.capsule.radius + self.body.margin * STOPS,
            ..self.body.capsule
        };
        let way = self.body.drift * dt;
        let Some(search) = FirstContact::new(&capsule.moved(-self.origin), [way; 2]) else {
            return;
        };
        let mut clamped = std::mem::take(&mut self.clamped);
        clamped.clear();
        for (handle, from, body) in before.moved_dynamic(bodies) {
            if self.is_apart(handle) {
                continue;
            }
            let Some(touch) = self.entered(search, body, &from, colliders, dt) else {
                continue;
            };
            let to = body.position();
            let depth_at = |pose: &Pose, capsule: &WorldCapsule| {
                deepest(body, pose, colliders, &capsule.moved(-self.origin))
            };
            let (mut pose, mut was) = (*to, 0.0);
            if touch.started_inside {
                // Rapier has the contact already. It gets no deeper than it was.
                was = depth_at(&from, &capsule).map_or(0.0, |(depth, _)| depth);
            } else {
                // For the rest of the tick it stays where it is relative to the climber.
                pose = between(&from, to, touch.time);
                pose.translation += (way * (1.0 - touch.time)).as_vec3();
            }
            // The search takes the points of a body that turns to move in straight lines.
            if let Some((depth, out)) = depth_at(&pose, &capsule.moved(way)) {
                pose.translation += (out * (depth - was).max(0.0)).as_vec3();
            }
            if pose != *to {
                clamped.push((handle, pose));
            }
        }
        for (handle, pose) in &clamped {
            if let Some(body) = bodies.get_mut(*handle) {
                body.set_position(*pose, true);
            }
        }
        if !clamped.is_empty() {
            // Queries of this tick see colliders, which rapier would move with the next step.
            bodies.propagate_modified_body_positions_to_colliders(colliders);
        }
        self.clamped = clamped;
    }

    /// Where a body first touched the climber, if it came by itself.
    fn entered(
        &self,
        mut search: FirstContact,
        body: &RigidBody,
        from: &Pose,
        colliders: &ColliderSet,
        dt: f64,
    ) -> Option<SweepContact> {
        let before = pose_of(from);
        let frame = self.body.frame_velocity * dt;
        let comes = |moved: &Moved, touch: &SweepContact| {
            let local = DVec3::from_array(touch.contact.material.coordinates);
            let was = moved.tick.before.unwrap_or(moved.tick.now);
            let own = moved.tick.now.transform(local) - was.transform(local) - frame;
            let is_below = self.body.is_below(-touch.separation_normal);
            own.dot(touch.separation_normal) > 0.0 && !is_below
        };
        for handle in body.colliders() {
            let collider = colliders.get(*handle).filter(|collider| is_solid(collider));
            let on_body =
                collider.and_then(|collider| Some((collider, collider.position_wrt_parent()?)));
            let Some((collider, on_body)) = on_body else {
                continue;
            };
            let on_body = pose_of(on_body);
            let now = pose_of(body.position()).compose(&on_body);
            let moved = Moved::new(collider.shape(), before.compose(&on_body), now);
            if search.may_meet(&moved.bounds) {
                let mut counts = |touch: &SweepContact| comes(&moved, touch);
                search.meet_where(collider.shape(), &moved.tick, 0, &mut counts);
            }
        }
        search.contact(DVec3::ZERO)
    }
}

/// How deep a body in a pose is in a capsule, and the unit vector along which it gets out; `None` if it is outside.
fn deepest(
    body: &RigidBody,
    pose: &Pose,
    colliders: &ColliderSet,
    capsule: &WorldCapsule,
) -> Option<(f64, DVec3)> {
    let mut deepest: Option<(f64, DVec3)> = None;
    for handle in body.colliders() {
        let collider = colliders.get(*handle).filter(|collider| is_solid(collider));
        let on_body =
            collider.and_then(|collider| Some((collider, collider.position_wrt_parent()?)));
        let Some((collider, on_body)) = on_body else {
            continue;
        };
        let pose = pose_of(pose).compose(&pose_of(on_body));
        let ends = capsule.ends.map(|end| pose.inverse_transform(end));
        overlap_shape(collider.shape(), ends, capsule.radius, &mut |found| {
            let depth = capsule.radius - found.distance;
            if deepest.is_none_or(|(most, _)| depth > most) {
                let away = nearest_on(ends, found.point) - found.point;
                let away = if found.distance > 0.0 {
                    away.normalize_or(found.normal)
                } else {
                    found.normal
                };
                deepest = Some((depth, pose.rotation * -away));
            }
        });
    }
    deepest
}

/// The point of a segment that is nearest to another point.
fn nearest_on([a, b]: [DVec3; 2], point: DVec3) -> DVec3 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared();
    // A ball's segment has no length.
    if share.is_finite() {
        a + along * share.clamp(0.0, 1.0)
    } else {
        a
    }
}

/// The pose of a body after a share of its way.
fn between(from: &Pose, to: &Pose, share: f64) -> Pose {
    let [a, b]: [RigidPose; 2] = [from, to].map(pose_of);
    let rotation = slerp(a.rotation, b.rotation, share);
    let rotation = Rotation::from_xyzw(
        rotation.x as f32,
        rotation.y as f32,
        rotation.z as f32,
        rotation.w as f32,
    );
    Pose::from_parts(a.translation.lerp(b.translation, share).as_vec3(), rotation)
}
