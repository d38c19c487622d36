use std::cell::LazyCell;

use clamber_surface::geometry::MovingCapsule;
use clamber_surface::mesh::SurfaceTag;
use glam::{DVec3, Vec3};
use parry3d::shape::Shape;

use super::convex::{Convex, MovingConvex};
use super::parts::{Part, visit_parts};
use super::swept_bounds::SweptBounds;
use crate::RigidPose;
use crate::{Contact, MaterialPoint};

/// A contact with a shape, in its local space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShapeContact {
    /// Point of the shape.
    pub point: DVec3,
    /// Unit normal that points out of the shape.
    pub normal: DVec3,
    /// Distance from the capsule's segment, metres. Negative inside a solid, where a translation by its magnitude along
    /// `normal` leads out.
    pub distance: f64,
}

impl ShapeContact {
    /// The contact in world space, with `key` as its [`MaterialPoint::key`]. `pose` places the shape in a space whose
    /// origin is at `origin` in the world. The tag is the default; the caller sets it.
    pub fn in_world(&self, pose: &RigidPose, origin: DVec3, key: u64) -> Contact {
        Contact {
            point: pose.transform(self.point) + origin,
            normal: (pose.rotation * self.normal).normalize_or(DVec3::Y),
            distance: self.distance,
            material: MaterialPoint {
                key,
                coordinates: self.point.to_array(),
            },
            tag: SurfaceTag::default(),
        }
    }
}

/// Calls `found` with the nearest point of each part of a shape within `radius` of the segment between `ends`. Parts
/// are the triangles of a mesh or height field, and convex solids. Everything is in the shape's local space. The radius
/// may be infinite. Finds nothing if an end is not finite or beyond 2^100, or if the radius is NaN or negative.
pub fn overlap_shape(
    shape: &dyn Shape,
    ends: [DVec3; 2],
    radius: f64,
    found: &mut dyn FnMut(ShapeContact),
) {
    let still = MovingCapsule {
        start: ends,
        end: ends,
        radius: 0.0,
    };
    if !SweptBounds::is_usable(ends, radius) {
        return;
    }
    let reach = LazyCell::new(|| SweptBounds::new(&still, radius));
    let mut offer = |contact: Option<ShapeContact>| {
        if let Some(contact) = contact.filter(|contact| contact.distance <= radius) {
            found(contact);
        }
    };
    visit_parts(
        shape,
        &|| reach.bounds(),
        &|bounds| reach.meets(bounds, 1.0),
        &mut |part| match part {
            Part::Triangle(corners) => offer(triangle(corners, &still)),
            Part::Convex(convex) => offer(Some(solid(&convex, ends))),
            Part::HalfSpace(normal) => offer(Some(half_space(normal, ends))),
            Part::Posed(pose, part) => {
                let local = ends.map(|end| pose.inverse_transform(end));
                overlap_shape(part, local, radius, &mut |contact| {
                    offer(Some(ShapeContact {
                        point: pose.transform(contact.point),
                        normal: pose.rotation * contact.normal,
                        ..contact
                    }));
                });
            }
        },
    );
}

fn triangle(corners: [Vec3; 3], still: &MovingCapsule) -> Option<ShapeContact> {
    let nearest = still.nearest_of_triangle(corners.map(|corner| corner.as_dvec3()))?;
    Some(ShapeContact {
        point: nearest.point,
        normal: nearest.normal.unwrap_or(nearest.separation_normal),
        distance: nearest.distance,
    })
}

/// The contact of a segment with a convex solid. If the segment meets the core, the contact is at the minimum
/// translation that leads out.
pub(super) fn solid(convex: &Convex<'_>, ends: [DVec3; 2]) -> ShapeContact {
    match MovingConvex::still(convex).nearest(0.0, ends, DVec3::ZERO) {
        Some(nearest) => ShapeContact {
            point: nearest.on_core + nearest.normal * convex.round,
            normal: nearest.normal,
            distance: nearest.distance - convex.round,
        },
        None => convex.way_out(ends),
    }
}

pub(super) fn half_space(normal: DVec3, ends: [DVec3; 2]) -> ShapeContact {
    let heights = ends.map(|end| normal.dot(end));
    let lower = usize::from(heights[1] < heights[0]);
    ShapeContact {
        point: ends[lower] - normal * heights[lower],
        normal,
        distance: heights[lower],
    }
}
