//! What an overlap query asks for: a ball or a capsule.

use glam::Vec3;

use super::broad::{self, Lanes};
use crate::geometry::triangle::{
    Corners8, Points8, TrianglePoint, closest_point, closest_points, closest_to_segment,
    closest_to_segments,
};
use crate::geometry::{Capsule, Sphere, round_to_f32, widen};
use crate::mesh::hierarchy::LANES;
use crate::simd::SimdLevel;
use crate::surface::SurfaceError;
use crate::surface::bounds::Spheres;

use super::check_length;

/// How far an exact test may be off, as a share of the lengths involved (segment, edges, distance):
/// four times the 2^-48 by which a segment that all but touches a triangle counts as crossing it, and
/// some thirty times what rounding takes. Less loses triangles that the exact test takes; more tests
/// more.
pub(super) const BLUR: f64 = 1.0 / (1u64 << 46) as f64;

/// All points within a radius of a core: a point, or a segment.
pub(in crate::surface) trait Region {
    /// Refuses what is not finite; gives the radius, which may be infinite.
    fn check(&self) -> Result<f64, SurfaceError>;

    /// Where a hit's normal points where its triangle has none.
    fn middle(&self) -> Vec3;

    /// The ends of the core.
    fn segment(&self) -> [Vec3; 2];

    /// Lanes whose sphere may touch it.
    fn near(&self, spheres: &Spheres) -> Lanes;

    /// Per lane at most the distance from its core to what the sphere holds.
    fn distances(&self, spheres: &Spheres) -> [f32; LANES];

    /// A point of its core, about the nearest to `target`, and how far rounding may have taken it off.
    fn facing(&self, target: Vec3) -> (Vec3, f64);

    /// How far beyond its radius the exact test may take a triangle for a touching one, of a surface
    /// that is `size` across.
    fn blur(&self, size: f64) -> f64;

    /// The point of a triangle closest to the core.
    fn closest(&self, corners: [Vec3; 3]) -> TrianglePoint;

    /// [`Region::closest`] for eight triangles.
    fn closest_of_eight(&self, level: SimdLevel, corners: &Corners8) -> Points8;
}

impl Region for Sphere {
    fn check(&self) -> Result<f64, SurfaceError> {
        check_point(self.center)?;
        check_length("the radius of a query", self.radius)
    }

    fn middle(&self) -> Vec3 {
        self.center
    }

    fn segment(&self) -> [Vec3; 2] {
        [self.center; 2]
    }

    fn near(&self, spheres: &Spheres) -> Lanes {
        broad::near_point(spheres, self.center, self.radius)
    }

    fn distances(&self, spheres: &Spheres) -> [f32; LANES] {
        broad::distances(spheres, self.center)
    }

    fn facing(&self, _target: Vec3) -> (Vec3, f64) {
        (self.center, 0.0)
    }

    fn blur(&self, _size: f64) -> f64 {
        // What a point's distance is off by is a share of itself: `box_around` pays for it.
        0.0
    }

    fn closest(&self, corners: [Vec3; 3]) -> TrianglePoint {
        closest_point(corners, self.center)
    }

    fn closest_of_eight(&self, level: SimdLevel, corners: &Corners8) -> Points8 {
        closest_points(level, corners, self.center)
    }
}

impl Region for Capsule {
    fn check(&self) -> Result<f64, SurfaceError> {
        check_point(self.a)?;
        check_point(self.b)?;
        check_length("the radius of a query", self.radius)
    }

    fn middle(&self) -> Vec3 {
        self.a * 0.5 + self.b * 0.5
    }

    fn segment(&self) -> [Vec3; 2] {
        [self.a, self.b]
    }

    fn near(&self, spheres: &Spheres) -> Lanes {
        broad::near_segment(spheres, self.a, self.b, self.radius)
    }

    fn distances(&self, spheres: &Spheres) -> [f32; LANES] {
        broad::distances_to_segment(spheres, self.a, self.b)
    }

    fn facing(&self, target: Vec3) -> (Vec3, f64) {
        let a = widen(self.a);
        let axis = widen(self.b) - a;
        let along = (widen(target) - a).dot(axis) / axis.length_squared();
        // An end where that is no number.
        let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
        let exact = a + axis * along;
        let rounded = round_to_f32(exact);
        let size = a.length() + axis.length();
        (rounded, (widen(rounded) - exact).length() + size * BLUR)
    }

    fn blur(&self, size: f64) -> f64 {
        let axis = widen(self.b) - widen(self.a);
        BLUR * (axis.length() + f64::from(self.radius) + size)
    }

    fn closest(&self, corners: [Vec3; 3]) -> TrianglePoint {
        closest_to_segment(corners, self.a, self.b)
    }

    fn closest_of_eight(&self, level: SimdLevel, corners: &Corners8) -> Points8 {
        closest_to_segments(level, corners, self.a, self.b)
    }
}

pub(in crate::surface) fn check_point(point: Vec3) -> Result<(), SurfaceError> {
    if point.is_finite() {
        Ok(())
    } else {
        Err(SurfaceError::Point)
    }
}

/// The box around all that can be within `distance` of the segment between two points, rounded
/// outwards.
pub(super) fn box_around([a, b]: [Vec3; 2], distance: f64) -> [[f32; 3]; 2] {
    // Some roundings of 2^-53 in the exact test.
    let distance = distance * (1.0 + 1e-12);
    let (low, high) = (a.min(b), a.max(b));
    [
        low.to_array().map(|x| {
            let bound = f64::from(x) - distance;
            let rounded = bound as f32;
            if f64::from(rounded) > bound {
                rounded.next_down()
            } else {
                rounded
            }
        }),
        high.to_array()
            .map(|x| crate::geometry::round_up_to_f32(f64::from(x) + distance)),
    ]
}
