//! Queries of one triangle in f32, for peers that have no such functions of their own.

use glam::Vec3;

use crate::peer::Nearest;

/// The point of a triangle closest to `p` (Ericson 2004, "Real-Time Collision Detection", 5.1.5).
pub(crate) fn closest_point(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

/// Takes a triangle's point closest to `p` if it is within a limit, and lowers the limit to its distance.
pub(crate) fn offer(p: Vec3, corners: [Vec3; 3], limit: &mut f32, nearest: &mut Option<Nearest>) {
    let point = closest_point(p, corners);
    let distance = point.distance(p);
    if distance <= *limit {
        *limit = distance;
        *nearest = Some(Nearest { point, distance });
    }
}

/// Distance along a ray at which it hits a triangle, from either side (Möller and Trumbore 1997).
pub(crate) fn cast_ray(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let inverse = 1.0 / ab.dot(across);
    let from = origin - a;
    let u = from.dot(across) * inverse;
    let along = from.cross(ab);
    let v = direction.dot(along) * inverse;
    let t = ac.dot(along) * inverse;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
}
