//! A skinned surface as an obstacle: queries go to model space and come back.

use clamber_surface::geometry::{Ray, Sphere, rotation_from_axis_angle};
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{Anchor, SkinnedSurface, SurfaceHit};
use glam::{DQuat, DVec3, Quat};

use crate::{Contact, MaterialPoint, Obstacle, PointMotion};

/// A hit in the world. `from` is the query's point, to which the distance is measured anew: the
/// one in the hit starts from the point's rounding to f32.
fn contact(surface: &SkinnedSurface, hit: &SurfaceHit, from: DVec3) -> Contact {
    let world_from_model = surface.world_from_model();
    let point = world_from_model.transform_point_f32(hit.point);
    Contact {
        point,
        normal: (world_from_model.rotation * hit.normal.as_dvec3()).normalize_or(DVec3::Y),
        distance: (from - point).length(),
        material: MaterialPoint {
            key: u64::from(hit.triangle.0),
            coordinates: hit.barycentric.map(f64::from),
        },
        tag: hit.tag,
    }
}

/// A length of the world in model units, in f32.
fn length_in_model(surface: &SkinnedSurface, length: f64) -> f32 {
    (length / surface.world_from_model().scale) as f32
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

    fn overlap_sphere(&self, center: DVec3, radius: f64, contacts: &mut Vec<Contact>) {
        let sphere = Sphere {
            center: self.world_from_model().inverse_transform_point_f32(center),
            radius: length_in_model(self, radius),
        };
        let start = contacts.len();
        let visited = self.visit_overlap_sphere(&sphere, |hit| {
            contacts.push(contact(self, &hit, center));
        });
        // A sphere that is not finite touches nothing.
        if visited.is_ok() {
            contacts[start..].sort_unstable_by_key(|contact| contact.material.key);
        }
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let triangle = TriangleId(u32::try_from(point.key).ok()?);
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
