//! A skinned surface as an obstacle: queries go to model space and come back.

use clamber_surface::geometry::{Capsule, Ray, Sphere, rotation_from_axis_angle};
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{Anchor, SkinnedSurface, SurfaceHit, SweepHit};
use glam::{DQuat, DVec3, Quat, Vec3};

use crate::{Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, WorldCapsule};

/// A hit in the world. `from` is the query's point, to which the distance is measured anew: the
/// one in the hit starts from the point's rounding to f32.
fn contact(surface: &SkinnedSurface, hit: &SurfaceHit, from: DVec3) -> Contact {
    let world_from_model = surface.world_from_model();
    let point = world_from_model.transform_point_f32(hit.point);
    Contact {
        point,
        normal: (world_from_model.rotation * hit.normal.as_dvec3()).normalize_or(DVec3::Y),
        distance: (from - point).length(),
        material: MaterialPoint::on_triangle(hit.triangle, hit.barycentric),
        tag: hit.tag,
    }
}

/// A length of the world in model units, in f32.
fn length_in_model(surface: &SkinnedSurface, length: f64) -> f32 {
    (length / surface.world_from_model().scale) as f32
}

fn capsule_in_model(surface: &SkinnedSurface, capsule: &WorldCapsule) -> Capsule {
    let world_from_model = surface.world_from_model();
    let [a, b] = capsule
        .ends
        .map(|end| world_from_model.inverse_transform_point_f32(end));
    Capsule {
        a,
        b,
        radius: length_in_model(surface, capsule.radius),
    }
}

fn ball_of(capsule: &Capsule) -> Sphere {
    Sphere {
        center: capsule.a,
        radius: capsule.radius,
    }
}

fn stays_ball(capsule: &WorldCapsule, displacements: [DVec3; 2]) -> bool {
    capsule.is_ball() && displacements[0] == displacements[1]
}

/// With the displacements and the tolerance, all in model units.
fn sweep_in_model(
    surface: &SkinnedSurface,
    capsule: &WorldCapsule,
    displacements: [DVec3; 2],
) -> (Capsule, [Vec3; 2], f32) {
    let world_from_model = surface.world_from_model();
    (
        capsule_in_model(surface, capsule),
        displacements.map(|displacement| {
            world_from_model
                .inverse_transform_vector(displacement)
                .as_vec3()
        }),
        length_in_model(surface, capsule.sweep_tolerance()),
    )
}

fn sweep_contact(surface: &SkinnedSurface, hit: &SweepHit) -> SweepContact {
    let world_from_model = surface.world_from_model();
    let direction = |v: Vec3| world_from_model.rotation * v.as_dvec3();
    let away = direction(hit.normal).normalize_or(DVec3::Y);
    SweepContact {
        time: hit.time,
        contact: Contact {
            point: world_from_model.transform_point_f32(hit.point),
            normal: direction(hit.surface_normal).normalize_or(away),
            distance: hit.distance * world_from_model.scale,
            material: MaterialPoint::on_triangle(hit.triangle, hit.barycentric),
            tag: hit.tag,
        },
        away,
        started_inside: hit.started_inside,
    }
}

impl MaterialPoint {
    /// A point of a surface: of a triangle, by barycentric coordinates.
    pub fn on_triangle(triangle: TriangleId, barycentric: [f32; 3]) -> Self {
        Self {
            key: u64::from(triangle.0),
            coordinates: barycentric.map(f64::from),
        }
    }

    /// The triangle of a point of a surface. Of a point of anything else, such as a rapier collider, it is any number, or
    /// `None`: ask only where the obstacle is a surface.
    pub fn triangle(&self) -> Option<TriangleId> {
        u32::try_from(self.key).ok().map(TriangleId)
    }
}

impl Obstacle for SkinnedSurface {
    fn bounds(&self) -> Option<(DVec3, f64)> {
        self.bounding_ball()
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let world_from_model = self.world_from_model();
        let start = world_from_model.inverse_transform_point_f32(origin);
        let along = world_from_model
            .inverse_transform_vector(direction.try_normalize()?)
            .normalize();
        let ray = Ray::new(start, along.as_vec3())?;
        let hit = self
            .cast_ray(&ray, length_in_model(self, max_distance))
            .ok()??;
        Some(contact(self, &hit, origin))
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let local = self.world_from_model().inverse_transform_point_f32(point);
        let hit = self
            .closest_point(local, length_in_model(self, max_distance))
            .ok()??;
        Some(contact(self, &hit, point))
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let local = capsule_in_model(self, capsule);
        let start = contacts.len();
        let mut found = |hit: SurfaceHit| {
            let mut contact = contact(self, &hit, capsule.ends[0]);
            if !capsule.is_ball() {
                let nearest = capsule.nearest_on_axis(contact.point);
                contact.distance = (nearest - contact.point).length();
            }
            contacts.push(contact);
        };
        let visited = if capsule.is_ball() {
            self.visit_overlap_sphere(&ball_of(&local), found)
        } else {
            self.visit_overlap_capsule(&local, &mut found)
        };
        // A capsule that is not finite touches nothing.
        if visited.is_ok() {
            contacts[start..].sort_unstable_by_key(|contact| contact.material.key);
        }
    }

    fn cast_capsule(&self, capsule: &WorldCapsule, displacement: DVec3) -> Option<SweepContact> {
        let (local, motions, tolerance) = sweep_in_model(self, capsule, [displacement; 2]);
        let hit = if capsule.is_ball() {
            self.cast_sphere(&ball_of(&local), motions[0], tolerance)
        } else {
            self.cast_capsule(&local, motions, tolerance)
        };
        Some(sweep_contact(self, &hit.ok()??))
    }

    fn sweep_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
    ) -> Option<SweepContact> {
        let (local, motions, tolerance) = sweep_in_model(self, capsule, displacements);
        let hit = if stays_ball(capsule, displacements) {
            self.sweep_sphere(&ball_of(&local), motions[0], tolerance)
        } else {
            self.sweep_capsule(&local, motions, tolerance)
        };
        Some(sweep_contact(self, &hit.ok()??))
    }

    fn sweep_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let (local, motions, tolerance) = sweep_in_model(self, capsule, displacements);
        let mut counts = |hit: &SweepHit| counts(&sweep_contact(self, hit));
        let hit = if stays_ball(capsule, displacements) {
            self.sweep_sphere_where(&ball_of(&local), motions[0], tolerance, &mut counts)
        } else {
            SkinnedSurface::sweep_capsule_where(self, &local, motions, tolerance, &mut counts)
        };
        Some(sweep_contact(self, &hit.ok()??))
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let triangle = point.triangle()?;
        if !self.is_enabled(triangle) {
            return None;
        }
        let anchor = Anchor {
            triangle,
            barycentric: point.coordinates.map(|weight| weight as f32),
            frame: Quat::IDENTITY,
        };
        let motion = self.motion(&anchor, dt).ok()?;
        let world_from_model = self.world_from_model();
        let spin = world_from_model.rotation * motion.angular_velocity.as_dvec3() * dt;
        let angle = spin.length();
        Some(PointMotion {
            position: world_from_model.transform_point_f32(motion.position),
            previous_position: world_from_model.transform_point_f32(motion.previous_position),
            velocity: world_from_model.transform_vector(motion.velocity.as_dvec3()),
            placed: self.is_placed(),
            frame: (!motion.collapsed)
                .then(|| (world_from_model.rotation * motion.frame.as_dquat()).normalize()),
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
