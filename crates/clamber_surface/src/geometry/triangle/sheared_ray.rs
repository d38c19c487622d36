//! A watertight test of a ray against a triangle.
//!
//! Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1). Corners are translated and sheared in
//! f32, in the same way for every triangle that shares them. The edge functions of the sheared corners are then
//! evaluated in f64, where the products of f32 numbers are exact, so their signs are the true ones. A ray can therefore
//! not slip between two triangles that share an edge or a corner by index.

use glam::{DVec3, Vec3};

use super::TrianglePoint;
use crate::geometry::Ray;

/// Allowance for rounding in f32, as a share of the lengths involved: some ten roundings of 2^-24.
const SLACK: f32 = 16.0 * f32::EPSILON;

/// A ray prepared for watertight tests.
pub(crate) struct ShearedRay {
    pub(crate) origin: Vec3,
    pub(crate) axes: [usize; 3],
    pub(crate) shear: [f32; 3],
}

impl ShearedRay {
    pub(crate) fn new(ray: &Ray) -> Self {
        let d = ray.direction().to_array();
        let mut z = 0;
        for axis in 1..3 {
            if d[axis].abs() > d[z].abs() {
                z = axis;
            }
        }
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self {
            origin: ray.origin(),
            axes: [x, y, z],
            shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]],
        }
    }

    /// Sheared x and y, and distance along the ray, of a vertex.
    ///
    /// The arithmetic is in f32, and has the same bits for one vertex as for many: the test is watertight only if each
    /// vertex has a single sheared position.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn shear(&self, vertex: Vec3) -> [f32; 3] {
        let local = (vertex - self.origin).to_array();
        let [x, y, z] = self.axes;
        let (x, y, z) = (local[x % 3], local[y % 3], local[z % 3]);
        [
            x - self.shear[0] * z,
            y - self.shear[1] * z,
            z * self.shear[2],
        ]
    }

    /// False only if the ray meets no triangle, within `limit`, whose corners all lie in the box from `low` to `high`.
    ///
    /// The box is sheared like its contents. Along each axis it then spans an interval about its middle.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn may_meet_box(&self, low: [f32; 3], high: [f32; 3], limit: f32) -> bool {
        let origin = self.origin.to_array();
        let [(x, half_x), (y, half_y), (z, half_z)] = self.axes.map(
            #[cfg_attr(not(unoptimized), inline(always))]
            |axis| {
                // Relative to the origin before anything else, as corners are.
                let (low, high) = (low[axis] - origin[axis], high[axis] - origin[axis]);
                (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5)
            },
        );
        // More than the error of the sheared corners plus the error of this test, both in f32.
        let size = x.abs() + y.abs() + z.abs() + half_x + half_y + half_z;
        let slack = SLACK * size + f32::MIN_POSITIVE;
        let [shear_x, shear_y, scale] = self.shear;
        let beside = |middle: f32, half: f32, shear: f32| {
            (middle - shear * z).abs() > half + shear.abs() * half_z + slack
        };
        let (along, reach) = (z * scale, (half_z + slack) * scale.abs());
        // Comparisons with NaN are false, so NaN may meet.
        !(beside(x, half_x, shear_x)
            | beside(y, half_y, shear_y)
            | (along + reach < 0.0)
            | (along - reach > limit))
    }

    /// The point where the ray meets the triangle, from either side, at a distance from 0 to `max_distance`. Edges and
    /// corners belong to the triangle. A triangle seen edge-on is missed.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn intersect(
        &self,
        [a, b, c]: [Vec3; 3],
        max_distance: f64,
    ) -> Option<TrianglePoint> {
        let corners = [self.shear(a), self.shear(b), self.shear(c)];
        intersect_sheared(corners, max_distance)
    }
}

/// [`ShearedRay::intersect`] for corners that are [sheared](ShearedRay::shear) already.
#[cfg_attr(not(unoptimized), inline(always))]
pub(crate) fn intersect_sheared(
    [a, b, c]: [[f32; 3]; 3],
    max_distance: f64,
) -> Option<TrianglePoint> {
    let [a, b, c] = [wide(a), wide(b), wide(c)];
    let u = c[0] * b[1] - c[1] * b[0];
    let v = a[0] * c[1] - a[1] * c[0];
    let w = b[0] * a[1] - b[1] * a[0];
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let determinant = u + v + w;
    if determinant == 0.0 {
        return None;
    }
    let barycentric = DVec3::new(u, v, w) / determinant;
    let distance = barycentric.x * a[2] + barycentric.y * b[2] + barycentric.z * c[2];
    // Written so that NaN, from corners that overflow, is a miss.
    (distance >= 0.0 && distance <= max_distance).then_some(TrianglePoint {
        barycentric,
        distance,
    })
}

#[cfg_attr(not(unoptimized), inline(always))]
fn wide([x, y, z]: [f32; 3]) -> [f64; 3] {
    [f64::from(x), f64::from(y), f64::from(z)]
}
