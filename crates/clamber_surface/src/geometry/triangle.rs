//! One triangle, or eight, against a point, a segment and a ray.
//!
//! All tests work in f64 on f32 corners, in coordinates relative to the query. Differences of f32 numbers of similar
//! size are exact in f64, so distance from the origin costs no precision.
//!
//! Error of distances to points and segments, as a share of the lengths involved (longest edge, segment, distance),
//! measured against rational arithmetic: below 5e-15. In slivers of height h and length 1 it is below 2^-53 / h, which
//! is 1e-9 at a height of 1e-7 (largest found: 1e-12).

mod candidate;
mod eight;
mod first_contact;
mod point;
mod segment;
mod sheared_ray;

pub(crate) use eight::{Corners8, EIGHT, Points8, closest_points, closest_to_segments};
pub(crate) use first_contact::{
    Contact, MovingCore, first_contact, first_contact_of_eight, first_contact_relative,
};
pub(crate) use point::closest_point;
pub(crate) use segment::{closest_to_segment, nearest_to_axis};
pub(crate) use sheared_ray::ShearedRay;
#[cfg(test)]
pub(crate) use sheared_ray::intersect_sheared;

use glam::{DVec3, Vec3};

use super::widen;

/// The point of a triangle that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrianglePoint {
    /// Weights of the corners: not negative, sum 1 up to rounding.
    pub(crate) barycentric: DVec3,
    /// Distance from the query's point or segment; for a ray, distance along it from its origin.
    pub(crate) distance: f64,
}

/// Corners in f64. Without an array's `map`: that goes through memory here, and stalls queries with many hits.
#[cfg_attr(not(unoptimized), inline(always))]
pub(crate) fn widened([a, b, c]: [Vec3; 3]) -> [DVec3; 3] {
    [widen(a), widen(b), widen(c)]
}

/// Cross product of two edges, in f64: it points along the counter-clockwise normal, and its length is twice the area.
pub(crate) fn scaled_normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = widened(corners);
    (b - a).cross(c - a)
}

/// The material point with the given corner weights, in f64.
pub(crate) fn point_at(corners: [Vec3; 3], barycentric: DVec3) -> DVec3 {
    let [a, b, c] = widened(corners);
    a * barycentric.x + b * barycentric.y + c * barycentric.z
}

#[cfg(test)]
mod tests;
