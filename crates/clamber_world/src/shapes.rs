//! What obstacles share whose engine has parry's shapes: rapier's and avian's answer alike.

use std::cmp::Ordering;

use clamber_surface::parry::parry3d;
use glam::{DQuat, DVec3, Quat};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::query::PointQuery;
use parry3d::shape::{Shape, Triangle, TypedShape};

use crate::{Contact, PointMotion};

/// First radius, in metres, of the search for the closest point; it doubles until something lies
/// within. Larger looks at more triangles where something is near, smaller searches longer where
/// nothing is.
const FIRST_REACH: f64 = 1.0;

/// Where a shape is touched, in its own space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeContact {
    /// The shape's point.
    pub point: Vector,
    /// Out of the shape.
    pub normal: Vector,
    /// Negative inside a solid.
    pub distance: f32,
}

/// Calls `found` for every triangle of a mesh or height field and every convex part within
/// `radius` of `center`, all in the shape's own space, with its nearest point.
pub fn overlap_shape(
    shape: &dyn Shape,
    center: Vector,
    radius: f32,
    found: &mut dyn FnMut(ShapeContact),
) {
    let reach = Aabb::new(
        center - Vector::splat(radius),
        center + Vector::splat(radius),
    );
    let mut triangle = |triangle: &Triangle| {
        let point = triangle.project_local_point(center, false).point;
        let distance = (center - point).length();
        if distance <= radius {
            let normal = triangle.normal().or((center - point).try_normalize());
            found(ShapeContact {
                point,
                normal: normal.unwrap_or(Vector::Y),
                distance,
            });
        }
    };
    match shape.as_typed_shape() {
        TypedShape::TriMesh(mesh) => {
            for id in mesh.bvh().intersect_aabb(&reach) {
                triangle(&mesh.triangle(id));
            }
        }
        TypedShape::HeightField(field) => {
            field.map_elements_in_local_aabb(&reach, &mut |_, t| triangle(t));
        }
        TypedShape::Triangle(single) => triangle(single),
        TypedShape::Compound(compound) => {
            for (pose, part) in compound.shapes() {
                let local = pose.inverse_transform_point(center);
                overlap_shape(&**part, local, radius, &mut |contact| {
                    found(ShapeContact {
                        point: pose.transform_point(contact.point),
                        normal: pose.transform_vector(contact.normal),
                        ..contact
                    });
                });
            }
        }
        _ => {
            let projection = shape.project_local_point(center, false);
            let between = center - projection.point;
            let apart = between.length();
            if projection.is_inside {
                found(ShapeContact {
                    point: projection.point,
                    normal: (-between).try_normalize().unwrap_or(Vector::Y),
                    distance: -apart,
                });
            } else if apart <= radius {
                found(ShapeContact {
                    point: projection.point,
                    normal: between.try_normalize().unwrap_or(Vector::Y),
                    distance: apart,
                });
            }
        }
    }
}

/// The contact of least distance up to `max_distance`, by overlaps of growing radius. `reach_of_all` is a radius
/// that reaches everything.
pub fn closest_by_overlap(
    max_distance: f64,
    reach_of_all: f64,
    mut overlap: impl FnMut(f64, &mut Vec<Contact>),
) -> Option<Contact> {
    if max_distance.is_nan() {
        return None;
    }
    let limit = max_distance.min(reach_of_all * 1.001);
    let mut contacts = Vec::new();
    let mut reach = FIRST_REACH.min(limit);
    loop {
        overlap(reach, &mut contacts);
        let nearest = contacts.iter().copied().min_by(|a, b| {
            let by_key = a.material.key.cmp(&b.material.key);
            a.distance.total_cmp(&b.distance).then(by_key)
        });
        if nearest.is_some() || reach >= limit {
            return nearest.filter(|contact| contact.distance <= max_distance);
        }
        reach = (reach * 2.0).min(limit);
    }
}

/// By ascending key, and by place and normal within one body, so that the order of its tree does not matter. In
/// place, so that a steady tick allocates nothing.
pub fn sort_contacts(contacts: &mut [Contact]) {
    let compare = |a: [f64; 3], b: [f64; 3]| {
        let each = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        each.fold(Ordering::Equal, Ordering::then)
    };
    contacts.sort_unstable_by(|a, b| {
        let by_key = a.material.key.cmp(&b.material.key);
        by_key
            .then_with(|| compare(a.material.coordinates, b.material.coordinates))
            .then_with(|| compare(a.normal.to_array(), b.normal.to_array()))
    });
}

/// A rigid pose in f64: engines round their own in f32 with every product.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPose {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Metres.
    pub translation: DVec3,
}

impl RigidPose {
    /// From an engine's pose; the rotation is normalised.
    pub fn new(rotation: Quat, translation: Vector) -> Self {
        Self {
            rotation: rotation.as_dquat().normalize(),
            translation: translation.as_dvec3(),
        }
    }

    /// This pose after `inner`.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.transform(inner.translation),
        }
    }

    /// A point of the body, in the space that the pose places it in.
    pub fn transform(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Undoes [`RigidPose::transform`].
    pub fn inverse_transform(&self, point: DVec3) -> DVec3 {
        self.rotation.conjugate() * (point - self.translation)
    }

    /// How a point of the body moves that was placed by `before` a tick of `dt` seconds ago, and by `self` now.
    /// `origin` is where the engine's own stands in the world. `None` unless `dt` is positive and the pose finite.
    pub fn motion_since(
        &self,
        before: &Self,
        local: DVec3,
        origin: DVec3,
        dt: f64,
    ) -> Option<PointMotion> {
        let position = self.transform(local) + origin;
        let previous_position = before.transform(local) + origin;
        let usable = dt > 0.0 && position.is_finite();
        usable.then(|| PointMotion {
            position,
            previous_position,
            velocity: (position - previous_position) / dt,
            frame: Some(self.rotation),
            turn: (self.rotation * before.rotation.conjugate()).normalize(),
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        })
    }
}
