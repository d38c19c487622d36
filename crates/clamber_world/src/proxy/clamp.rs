use clamber_surface::geometry::slerp;
use glam::DVec3;
use parry3d::shape::Shape;

use super::ProxyBody;
use crate::shapes::{FirstContact, Moved, overlap_shape};
use crate::{RigidPose, SweepContact, WorldCapsule};

/// Distance from the climber at which a body is stopped, as a fraction of the layer around the climber. The body then
/// overlaps the engine's body of the climber, so that the engine's next step finds the contact. The overlap is larger
/// than the depth to which engines let resting bodies overlap.
const STOPS: f64 = 0.4;

/// Rounding error of a bounding sphere in f32, several times over, as a share of its radius.
const ROUNDING: f64 = 1e-6;

impl ProxyBody {
    /// The pose for a body that entered the climber by its own motion in a step of a physics engine: where it first
    /// touched the climber, and carried along with the climber for the rest of the tick. `None` if it did not enter, or
    /// is below the climber.
    ///
    /// Engines find contacts once a step. Without this correction, a fast body is inside the climber for a tick before
    /// the engine stops it, and presses the climber away. The method is the motion clamping of continuous collision
    /// detection, in the climber's frame. A body that turns by at most one radian in the step ends outside of the
    /// climber; a body that turns faster may end in it.
    ///
    /// `from` and `to` are the body's poses before the step and after it, in a space with its origin at `origin`.
    /// `solids` are its shapes, with their poses on the body. `dt` is the length of the tick, seconds.
    pub fn stop<'a>(
        &self,
        origin: DVec3,
        [from, to]: [&RigidPose; 2],
        solids: impl Iterator<Item = (&'a dyn Shape, RigidPose)> + Clone,
        dt: f64,
    ) -> Option<RigidPose> {
        let capsule = WorldCapsule {
            radius: self.capsule.radius + self.margin * STOPS,
            ..self.capsule.moved(-origin)
        };
        let way = self.drift * dt;
        let path = [from.translation, to.translation - way];
        if solids.clone().all(|solid| is_far(solid, path, &capsule)) {
            return None;
        }
        let touch = self.entered(&capsule, [from, to], solids.clone(), dt)?;
        let (mut pose, mut was) = (*to, 0.0);
        if touch.started_inside {
            // The engine has the contact already. The body gets no deeper than it was.
            was = deepest(from, solids.clone(), &capsule).map_or(0.0, |(depth, _)| depth);
        } else {
            // For the rest of the tick the body stays where it is relative to the climber.
            pose = between(from, to, touch.fraction);
            pose.translation += way * (1.0 - touch.fraction);
        }
        // The search assumes that the points of a turning body move in straight lines, so the body may still be too
        // deep.
        if let Some((depth, out)) = deepest(&pose, solids, &capsule.moved(way)) {
            pose.translation += out * (depth - was).max(0.0);
        }
        (pose != *to).then_some(pose)
    }

    /// The first contact of a body with the climber, if the body came by itself.
    fn entered<'a>(
        &self,
        capsule: &WorldCapsule,
        [from, to]: [&RigidPose; 2],
        solids: impl Iterator<Item = (&'a dyn Shape, RigidPose)>,
        dt: f64,
    ) -> Option<SweepContact> {
        let mut search = FirstContact::new(capsule, [self.drift * dt; 2])?;
        let frame = self.frame_velocity * dt;
        let comes = |moved: &Moved, touch: &SweepContact| {
            let local = DVec3::from_array(touch.contact.material.coordinates);
            let was = moved.tick.before.unwrap_or(moved.tick.now);
            let own = moved.tick.now.transform(local) - was.transform(local) - frame;
            own.dot(touch.separation_normal) > 0.0 && !self.is_below(-touch.separation_normal)
        };
        for (shape, on_body) in solids {
            let moved = Moved::new(shape, from.compose(&on_body), to.compose(&on_body));
            if search.may_meet(&moved.bounds) {
                let mut counts = |touch: &SweepContact| comes(&moved, touch);
                search.meet_where(shape, &moved.tick, 0, &mut counts);
            }
        }
        search.contact(DVec3::ZERO)
    }
}

/// True if a shape of a body cannot reach a capsule while the body's origin moves along a path, however the body turns.
fn is_far((shape, on_body): (&dyn Shape, RigidPose), path: [DVec3; 2], to: &WorldCapsule) -> bool {
    let sphere = shape.compute_local_bounding_sphere();
    let around = sphere.center.as_dvec3().length() + f64::from(sphere.radius);
    let [a, b] = to.ends;
    let near = on_body.translation.length()
        + around * (1.0 + ROUNDING)
        + a.distance(b) * 0.5
        + to.radius
        + 2.0 * to.sweep_tolerance();
    let middle = a.midpoint(b);
    nearest_on(path, middle).distance_squared(middle) > near * near
}

/// The largest depth of a body in a capsule, and the unit vector along which the body gets out; `None` if it is
/// outside.
fn deepest<'a>(
    body: &RigidPose,
    solids: impl Iterator<Item = (&'a dyn Shape, RigidPose)>,
    capsule: &WorldCapsule,
) -> Option<(f64, DVec3)> {
    let mut deepest: Option<(f64, DVec3)> = None;
    for (shape, on_body) in solids {
        let pose = body.compose(&on_body);
        let ends = capsule.ends.map(|end| pose.inverse_transform(end));
        overlap_shape(shape, ends, capsule.radius, &mut |found| {
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
fn between(from: &RigidPose, to: &RigidPose, share: f64) -> RigidPose {
    RigidPose {
        rotation: slerp(from.rotation, to.rotation, share),
        translation: from.translation.lerp(to.translation, share),
    }
}

#[cfg(test)]
mod tests;
