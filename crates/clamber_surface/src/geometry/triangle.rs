//! One triangle against a point and against a ray.
//!
//! Both work in f64 on f32 corners and in coordinates relative to the query: the differences of
//! f32 numbers of similar size are exact there, so distance from the origin costs no digits.

use glam::{DVec3, Vec3};

use super::{Ray, widen};

/// The point of a triangle that a query found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrianglePoint {
    /// Weights of the corners: not negative, sum 1 up to rounding.
    pub(crate) barycentric: DVec3,
    /// Distance from the query's point or, along its direction, from the ray's origin.
    pub(crate) distance: f64,
}

/// The point of triangle `corners` nearest to `p`.
///
/// Takes the best of the perpendicular foot, where it falls inside, and the nearest points of the
/// three edges, where the usual decision by Voronoi regions (Ericson 2004, 5.1.5) would trust one
/// sign. Whatever rounding does to slivers, the answer is a point of the triangle, and a triangle
/// of zero area answers as the segment or point that it is.
pub(crate) fn closest_point(corners: [Vec3; 3], p: Vec3) -> TrianglePoint {
    let p = widen(p);
    let [a, b, c] = corners.map(|corner| widen(corner) - p);
    let mut best = closest_on_edge(a, b, |t| DVec3::new(1.0 - t, t, 0.0));
    for edge in [
        closest_on_edge(b, c, |t| DVec3::new(0.0, 1.0 - t, t)),
        closest_on_edge(c, a, |t| DVec3::new(t, 0.0, 1.0 - t)),
    ] {
        if edge.distance < best.distance {
            best = edge;
        }
    }
    let normal = (b - a).cross(c - a);
    let weights = DVec3::new(
        normal.dot(b.cross(c)),
        normal.dot(c.cross(a)),
        normal.dot(a.cross(b)),
    );
    let sum = weights.x + weights.y + weights.z;
    if weights.min_element() >= 0.0 && sum > 0.0 {
        let weights = weights / sum;
        let foot = a * weights.x + b * weights.y + c * weights.z;
        let distance = foot.length();
        if distance < best.distance {
            best = TrianglePoint {
                barycentric: weights,
                distance,
            };
        }
    }
    best
}

/// The point of segment `a` to `b` nearest to the origin, with its corner weights.
///
/// Computed from the lexicographically smaller end, so that two triangles that share the edge find
/// the same distance in every bit: a tie between them is then a tie.
fn closest_on_edge(a: DVec3, b: DVec3, weights: impl Fn(f64) -> DVec3) -> TrianglePoint {
    let swapped = b.to_array() < a.to_array();
    let (a, b) = if swapped { (b, a) } else { (a, b) };
    let along = b - a;
    let length_sq = along.length_squared();
    let t = if length_sq > 0.0 {
        (-a.dot(along) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    TrianglePoint {
        barycentric: weights(if swapped { 1.0 - t } else { t }),
        // Relative to b in the second half, so that t = 1 gives b itself.
        distance: if t <= 0.5 {
            (a + along * t).length()
        } else {
            (b - along * (1.0 - t)).length()
        },
    }
}

/// A ray prepared for watertight tests: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
/// Intersection", JCGT 2(1).
///
/// Corners are translated and sheared in f32, the same way for every triangle that shares them;
/// the edge functions of the sheared corners are then evaluated in f64, where the products of f32
/// numbers are exact, so their signs are the true ones. A ray can therefore not slip between two
/// triangles that share an edge or a corner by index.
pub(crate) struct ShearedRay {
    origin: Vec3,
    axes: [usize; 3],
    shear: [f32; 3],
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

    /// Sheared x and y, and distance along the ray, of a corner.
    fn shear(&self, corner: Vec3) -> [f64; 3] {
        let local = (corner - self.origin).to_array();
        let [x, y, z] = self.axes.map(|axis| local[axis]);
        [
            f64::from(x - self.shear[0] * z),
            f64::from(y - self.shear[1] * z),
            f64::from(z * self.shear[2]),
        ]
    }

    /// Where the ray meets the triangle, from either side, between distance 0 and `max_distance`.
    /// Borders belong to the triangle. A triangle seen edge-on is not met.
    pub(crate) fn intersect(&self, corners: [Vec3; 3], max_distance: f64) -> Option<TrianglePoint> {
        let [a, b, c] = corners.map(|corner| self.shear(corner));
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
}

/// Cross product of two edges, in f64: twice the area long, along the counter-clockwise normal.
pub(crate) fn scaled_normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(widen);
    (b - a).cross(c - a)
}

/// The material point with the given corner weights, in f64.
pub(crate) fn point_at(corners: [Vec3; 3], barycentric: DVec3) -> DVec3 {
    let [a, b, c] = corners.map(widen);
    a * barycentric.x + b * barycentric.y + c * barycentric.z
}

#[cfg(test)]
mod tests;
