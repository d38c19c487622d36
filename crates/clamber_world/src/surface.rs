//! A skinned surface as an obstacle.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{
    Anchor, CastOptions, SkinnedSurface, SurfaceHit, SurfacePoint, SweepHit, TargetMotion,
    WorldPath,
};
use glam::{DQuat, DVec3, Quat};

use crate::{Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, WorldCapsule};

impl From<SurfaceHit<DVec3>> for Contact {
    fn from(hit: SurfaceHit<DVec3>) -> Self {
        Self {
            point: hit.point,
            normal: hit.normal,
            distance: hit.distance,
            material: MaterialPoint::on_triangle(hit.triangle, hit.barycentric),
            tag: hit.tag,
        }
    }
}

impl From<SweepHit<DVec3>> for SweepContact {
    fn from(hit: SweepHit<DVec3>) -> Self {
        Self {
            fraction: hit.fraction,
            contact: hit.hit.into(),
            separation_normal: hit.separation_normal,
            started_inside: hit.started_inside,
        }
    }
}

impl MaterialPoint {
    /// The point of a skinned surface at these barycentric coordinates on a triangle.
    ///
    /// The point does not store its surface, and nothing is checked. Use it only with the surface that the triangle
    /// belongs to. There, [`Obstacle::motion`] is `None` for a triangle that does not exist, and for weights that are
    /// negative or do not add up to 1.
    pub fn on_triangle(triangle: TriangleId, barycentric: [f32; 3]) -> Self {
        Self {
            key: u64::from(triangle.0),
            coordinates: barycentric.map(f64::from),
        }
    }

    /// The triangle that the point lies on, if its obstacle is a skinned surface. For a point of any other obstacle,
    /// such as a rapier collider, the result has no meaning.
    pub fn triangle(&self) -> Option<TriangleId> {
        u32::try_from(self.key).ok().map(TriangleId)
    }

    /// An anchor at this point of a surface in its current pose, for example for a splinter under a foot. `None` if the
    /// surface never had the triangle or has removed it, or if the coordinates are not valid barycentric weights. The
    /// point does not store its surface: pass the one that the contact was found on.
    pub fn anchor_on(&self, surface: &SkinnedSurface) -> Option<Anchor> {
        surface.anchor(self.triangle()?, self.weights()).ok()
    }

    fn weights(&self) -> [f32; 3] {
        self.coordinates.map(|weight| weight as f32)
    }
}

/// Cast options with the tolerance that [`Obstacle::cast_capsule`] promises.
fn options(capsule: &WorldCapsule, target: TargetMotion) -> CastOptions {
    CastOptions::from(target).with_tolerance(capsule.sweep_tolerance())
}

fn cast_where(
    surface: &SkinnedSurface,
    capsule: &WorldCapsule,
    displacements: [DVec3; 2],
    options: &CastOptions,
    counts: &mut dyn FnMut(&SweepContact) -> bool,
) -> Option<SweepContact> {
    let mut counts = |hit: &SweepHit<DVec3>| counts(&(*hit).into());
    let space = surface.in_world();
    let hit = space.cast_capsule_where(capsule, displacements, options, &mut counts);
    hit.map(SweepContact::from)
}

impl Obstacle for SkinnedSurface {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        self.bounding_ball()
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let hit = self.in_world().cast_ray(origin, direction, max_distance);
        hit.map(Contact::from)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let hit = self.in_world().closest_point(point, max_distance);
        hit.map(Contact::from)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let start = contacts.len();
        self.in_world()
            .visit_overlap_capsule(capsule, |hit| contacts.push(hit.into()));
        contacts[start..].sort_unstable_by_key(|contact| contact.material.key);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let (space, options) = (self.in_world(), options(capsule, target));
        let hit = space.cast_capsule(capsule, displacements, &options);
        hit.map(SweepContact::from)
    }

    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let options = options(capsule, target);
        cast_where(self, capsule, displacements, &options, counts)
    }

    fn cast_capsule_past_overlaps(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let options = options(capsule, target).past_overlaps();
        cast_where(self, capsule, displacements, &options, counts)
    }

    fn path(&self, point: &MaterialPoint, dt: f64) -> Option<WorldPath> {
        let triangle = point.triangle()?;
        let point = SurfacePoint {
            mesh: self.mesh().id(),
            triangle,
            barycentric: point.weights(),
        };
        let is_there = self.is_enabled(triangle);
        let path = is_there.then(|| self.in_world().path(point, dt).ok())??;
        path.is_finite().then_some(path)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let triangle = point.triangle()?;
        if !self.is_enabled(triangle) {
            return None;
        }
        // The anchor's own frame is the fallback for collapsed skin, whose frame is not reported below.
        let anchor = Anchor {
            mesh: self.mesh().id(),
            triangle,
            barycentric: point.weights(),
            frame: Quat::IDENTITY,
        };
        let motion = self.in_world().motion(&anchor, dt).ok()?;
        let spin = motion.angular_velocity * dt;
        let angle = spin.length();
        Some(PointMotion {
            position: motion.position,
            previous_position: motion.previous_position,
            velocity: motion.velocity,
            was_teleported: self.was_teleported(),
            frame: (!motion.collapsed).then_some(motion.frame),
            turn: if angle > 0.0 {
                rotation_from_axis_angle(spin / angle, angle)
            } else {
                DQuat::IDENTITY
            },
            area_ratio: f64::from(motion.area_ratio),
            stretches: motion.stretches.map(f64::from),
        })
    }
}

#[cfg(test)]
mod tests;
