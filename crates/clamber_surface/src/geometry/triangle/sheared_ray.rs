//! A watertight test of a ray against a triangle.
//!
//! Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1). Corners are translated and sheared in
//! f32, in the same way for every triangle that shares them. The edge functions of the sheared corners are then
//! evaluated in f64, where the products of f32 numbers are exact, so their signs are the true ones. A ray can therefore
//! not slip between two triangles that share an edge or a corner by index.

use glam::{DVec3, Vec3};

use super::TrianglePoint;
use crate::geometry::Ray;

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
    /// All of it is in f32, and it has the same bits for one vertex as for many: the test is watertight only if each
    /// vertex has a single sheared position.
    pub(crate) fn shear(&self, vertex: Vec3) -> [f32; 3] {
        let local = (vertex - self.origin).to_array();
        let [x, y, z] = self.axes.map(|axis| local[axis]);
        [
            x - self.shear[0] * z,
            y - self.shear[1] * z,
            z * self.shear[2],
        ]
    }

    /// The point where the ray meets the triangle, from either side, at a distance from 0 to `max_distance`. Edges and
    /// corners belong to the triangle. A triangle seen edge-on is missed.
    pub(crate) fn intersect(&self, corners: [Vec3; 3], max_distance: f64) -> Option<TrianglePoint> {
        intersect_sheared(corners.map(|corner| self.shear(corner)), max_distance)
    }
}

/// [`ShearedRay::intersect`] for corners that are [sheared](ShearedRay::shear) already.
pub(crate) fn intersect_sheared(
    corners: [[f32; 3]; 3],
    max_distance: f64,
) -> Option<TrianglePoint> {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
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
