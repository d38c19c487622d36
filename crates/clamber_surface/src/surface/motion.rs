//! The motion of a material point, and the stretch of the skin around it, from the previous tick to the current one.

use glam::{DQuat, DVec3, Quat, Vec3};

use super::anchor::{check_barycentric, check_mesh};
use super::deformation::{Flattened, Rest, stretch};
use super::{Anchor, ModelSpace, SurfaceError, SurfacePoint};
use crate::geometry::triangle::point_at;
use crate::geometry::{rotation_vector, round_to_f32, widen};
use crate::mesh::PartId;
use crate::rig::{rotation_f32, rotation_f64};

/// The motion of an anchor over one tick, in the *current* model frame: a moving root moves the anchor too. Velocities
/// are differences over `dt`, never instantaneous.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// The point's current position.
    pub position: Vec3,
    /// The point's position a tick ago.
    pub previous_position: Vec3,
    /// Displacement over the tick, in model units per second.
    pub velocity: Vec3,
    /// Rotation of the material around the point from rest to now. It is the rotation nearest to the triangle's
    /// deformation: stretch does not turn it, and shear turns it by about half the angle of the shear. It rotates a
    /// direction of the rest pose to its current heading.
    pub frame: Quat,
    /// Rotation from the frame of a tick ago to the current one, by at most half a turn: axis times radians per second.
    pub angular_velocity: Vec3,
    /// Outward unit normal of the triangle now. If the triangle has collapsed: the normal that follows from `frame`.
    pub normal: Vec3,
    /// True if the triangle has collapsed now, so `frame` and `normal` are the last known ones. A sliver without an
    /// orientation even at rest turns with its joint, and does not count.
    pub collapsed: bool,
    /// Area now over area a tick ago, at most `f32::MAX`; 1 if the triangle was collapsed a tick ago.
    pub area_ratio: f32,
    /// Principal stretches since a tick ago, length now over length then, larger first, at most `f32::MAX`; both 1 if
    /// the triangle was collapsed a tick ago.
    pub stretches: [f32; 2],
}

/// The current and previous position of a material point, in the *current* model frame: the part of its [`Motion`] that
/// needs no frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointPath {
    /// The point's current position.
    pub position: Vec3,
    /// The point's position a tick ago.
    pub previous_position: Vec3,
    /// Displacement over the tick, in model units per second.
    pub velocity: Vec3,
}

impl ModelSpace<'_> {
    /// The positions of a point now and a tick of `dt` seconds ago, and its velocity. They equal the results of
    /// [`ModelSpace::motion`], for a fraction of the time. Skins the triangle's three vertices.
    ///
    /// # Errors
    /// As [`ModelSpace::motion`].
    pub fn path(&self, point: impl Into<SurfacePoint>, dt: f64) -> Result<PointPath, SurfaceError> {
        let (point, instance) = (point.into(), self.instance);
        self.check(&point, dt)?;
        let triangle = point.triangle;
        let weights = widen(Vec3::from_array(point.barycentric));
        let position = point_at(instance.corners(triangle), weights);
        let previous = point_at(instance.corners_in(&instance.previous, triangle), weights);
        let velocity = (position - previous) / dt;
        if velocity.length() > f64::from(f32::MAX) {
            return Err(SurfaceError::ShortTick(dt));
        }
        Ok(PointPath {
            position: round_to_f32(position),
            previous_position: round_to_f32(previous),
            velocity: round_to_f32(velocity),
        })
    }

    /// The motion of an anchor over a tick of `dt` seconds. Skins the triangle's three vertices.
    ///
    /// # Errors
    /// [`SurfaceError::ForeignMesh`] if the anchor belongs to another mesh, [`SurfaceError::Triangle`] if its triangle
    /// does not exist or was removed, [`SurfaceError::Barycentric`] if its weights are not finite, are negative, or do
    /// not add up to 1, [`SurfaceError::Tick`] if `dt` is not positive and finite, [`SurfaceError::ShortTick`] if a
    /// velocity over `dt` does not fit in f32.
    pub fn motion(&self, anchor: &Anchor, dt: f64) -> Result<Motion, SurfaceError> {
        let (triangle, instance) = (anchor.triangle, self.instance);
        let part = self.check(&anchor.into(), dt)?;
        let rest = Rest::new(instance.mesh.rest_corners(triangle));
        let before = instance.corners_in(&instance.previous, triangle);
        let now = instance.corners(triangle);
        let [flat_before, flat_now] = [before, now].map(Flattened::new);
        let (flat_before, flat_now) = (flat_before.as_ref(), flat_now.as_ref());

        let weights = widen(Vec3::from_array(anchor.barycentric));
        let (position, previous) = (point_at(now, weights), point_at(before, weights));
        let joint = instance.mesh.joint_of_part(part).index();
        let previous_frame = rest.frame(flat_before, &instance.previous.palette()[joint]);
        let current_frame = rest.frame(flat_now, &instance.current.palette()[joint]);
        let frame = current_frame
            .or(previous_frame)
            .unwrap_or_else(|| last_frame(anchor));
        let previous_frame = previous_frame.unwrap_or(frame);
        let sign = if instance.is_mirrored(part) {
            -1.0
        } else {
            1.0
        };
        let normal = match flat_now {
            Some(flat) => flat.normal() * sign,
            None => frame * rest.scaled_normal().normalize_or(DVec3::Y) * sign,
        };
        let (area_ratio, stretches) = stretch([before, now], [flat_before, flat_now]);
        let velocity = (position - previous) / dt;
        let angular_velocity = rotation_vector(frame * previous_frame.conjugate()) / dt;
        if velocity.length().max(angular_velocity.length()) > f64::from(f32::MAX) {
            return Err(SurfaceError::ShortTick(dt));
        }
        Ok(Motion {
            position: round_to_f32(position),
            previous_position: round_to_f32(previous),
            velocity: round_to_f32(velocity),
            frame: rotation_f32(frame),
            angular_velocity: round_to_f32(angular_velocity),
            normal: round_to_f32(normal),
            collapsed: current_frame.is_none(),
            area_ratio: finite(area_ratio),
            stretches: stretches.map(finite),
        })
    }
}

impl ModelSpace<'_> {
    /// The part that a point lies on; an error if there is no such point, or if a tick cannot take `dt` seconds.
    fn check(&self, point: &SurfacePoint, dt: f64) -> Result<PartId, SurfaceError> {
        let mesh = &self.instance.mesh;
        check_mesh(mesh, point.mesh)?;
        let part = mesh.part_of(point.triangle);
        let part = part.ok_or(SurfaceError::Triangle(point.triangle))?;
        check_barycentric(point.barycentric)?;
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(SurfaceError::Tick(dt));
        }
        Ok(part)
    }
}

/// Rounds to f32, at most to `f32::MAX`.
fn finite(ratio: f64) -> f32 {
    (ratio as f32).min(f32::MAX)
}

/// The frame that an anchor stores; no rotation if that is not a rotation.
fn last_frame(anchor: &Anchor) -> DQuat {
    let frame = rotation_f64(anchor.frame);
    if frame.is_finite() && frame.length_squared() > 0.0 {
        frame.normalize()
    } else {
        DQuat::IDENTITY
    }
}

#[cfg(test)]
mod tests;
