//! A query against the eight spheres of a node, in f32.
//!
//! Every test errs on the side of a touch: it is widened by more than f32 arithmetic can be off, and
//! written so that NaN and infinity, from coordinates whose squares overflow, touch. Squares that
//! underflow do no harm, since every sphere has a radius of at least 2^-56.

use glam::Vec3;

use crate::geometry::Ray;
use crate::mesh::hierarchy::LANES;
use crate::surface::bounds::Spheres;

/// How far f32 arithmetic may be off, as a share of the lengths involved. Some ten roundings of
/// 2^-24 are; less risks a missed triangle, more tests more.
pub(super) const SLACK: f32 = 16.0 * f32::EPSILON;

/// The length whose square f32 no longer holds, rounded down.
const SQUARE_OVERFLOWS: f32 = 1.8e19;

/// 2^60: products and sums of squares of lengths up to this are far from the end of f32.
pub(super) const LONG: f32 = (1u64 << 60) as f32;

/// One bit a lane.
pub(super) type Lanes = u8;

pub(super) fn lanes(test: impl Fn(usize) -> bool) -> Lanes {
    let mut found = 0;
    for lane in 0..LANES {
        found |= Lanes::from(test(lane)) << lane;
    }
    found
}

/// Lanes whose sphere is within `radius` of `center`.
pub(super) fn near_point(spheres: &Spheres, center: Vec3, radius: f32) -> Lanes {
    let [mut distance_sq, mut reach_sq] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let dx = spheres.x[lane] - center.x;
        let dy = spheres.y[lane] - center.y;
        let dz = spheres.z[lane] - center.z;
        distance_sq[lane] = dx * dx + dy * dy + dz * dz;
        let reach = spheres.radius[lane] + radius;
        reach_sq[lane] = reach * reach * (1.0 + SLACK);
    }
    // Negated, so that NaN touches.
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    lanes(|lane| !(distance_sq[lane] > reach_sq[lane]))
}

/// Lanes whose sphere is within `radius` of the segment from `a` to `b`; all that are [`LONG`] away or
/// beside a segment that long, since where a product overflows, any place along it may come out.
pub(super) fn near_segment(spheres: &Spheres, a: Vec3, b: Vec3, radius: f32) -> Lanes {
    let (distance_sq, lost) = from_segment(spheres, a, b);
    let mut reach_sq = [0.0; LANES];
    for lane in 0..LANES {
        let reach = spheres.radius[lane] + radius + lost[lane];
        reach_sq[lane] = reach * reach * (1.0 + SLACK);
    }
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    lanes(|lane| !(distance_sq[lane] > reach_sq[lane]))
}

/// Per lane at most the distance from the segment from `a` to `b` to what the sphere holds.
pub(super) fn distances_to_segment(spheres: &Spheres, a: Vec3, b: Vec3) -> [f32; LANES] {
    let (distance_sq, lost) = from_segment(spheres, a, b);
    let mut found = [0.0; LANES];
    for (lane, found) in found.iter_mut().enumerate() {
        let apart = distance_sq[lane].sqrt();
        let apart = if apart < SQUARE_OVERFLOWS {
            apart
        } else {
            SQUARE_OVERFLOWS
        };
        let gap = apart * (1.0 - SLACK) - spheres.radius[lane] * (1.0 + SLACK) - lost[lane];
        *found = if gap > 0.0 { gap } else { 0.0 };
    }
    found
}

/// Squares of the distances of centres from the segment from `a` to `b`, and what rounding may have
/// added to the distances: infinity from [`LONG`] on.
fn from_segment(spheres: &Spheres, a: Vec3, b: Vec3) -> ([f32; LANES], [f32; LANES]) {
    let axis = b - a;
    let length_sq = axis.length_squared();
    let inverse = if length_sq > 0.0 {
        1.0 / length_sq
    } else {
        0.0
    };
    let size = axis.x.abs() + axis.y.abs() + axis.z.abs();
    let [mut distance_sq, mut lost] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let dx = spheres.x[lane] - a.x;
        let dy = spheres.y[lane] - a.y;
        let dz = spheres.z[lane] - a.z;
        let along = (dx * axis.x + dy * axis.y + dz * axis.z) * inverse;
        let along = if along > 0.0 { along } else { 0.0 };
        let along = if along < 1.0 { along } else { 1.0 };
        // Any point of the segment will do: one that is off by rounding is hardly farther.
        let ox = dx - axis.x * along;
        let oy = dy - axis.y * along;
        let oz = dz - axis.z * along;
        distance_sq[lane] = ox * ox + oy * oy + oz * oz;
        let apart = dx.abs() + dy.abs() + dz.abs() + size;
        lost[lane] = SLACK * if apart < LONG { apart } else { f32::INFINITY };
    }
    (distance_sq, lost)
}

/// Per lane at most the distance from a point to what the sphere holds.
pub(super) fn distances(spheres: &Spheres, point: Vec3) -> [f32; LANES] {
    let mut found = [0.0; LANES];
    for (lane, found) in found.iter_mut().enumerate() {
        let dx = spheres.x[lane] - point.x;
        let dy = spheres.y[lane] - point.y;
        let dz = spheres.z[lane] - point.z;
        let apart = (dx * dx + dy * dy + dz * dz).sqrt();
        let apart = if apart < SQUARE_OVERFLOWS {
            apart
        } else {
            SQUARE_OVERFLOWS
        };
        let gap = apart * (1.0 - SLACK) - spheres.radius[lane] * (1.0 + SLACK);
        *found = if gap > 0.0 { gap } else { 0.0 };
    }
    found
}

/// Lanes whose sphere a ray meets within `limit`, and per lane at most the distance along the ray to
/// what it holds.
///
/// By the perpendicular from the centre to the ray, which keeps its digits far out where the usual
/// discriminant loses them.
pub(super) fn along_ray(spheres: &Spheres, ray: &Ray, limit: f32) -> (Lanes, [f32; LANES]) {
    let (origin, direction) = (ray.origin(), ray.direction());
    let [mut distance_sq, mut reach_sq] = [[0.0; LANES]; 2];
    let [mut first, mut last] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let dx = spheres.x[lane] - origin.x;
        let dy = spheres.y[lane] - origin.y;
        let dz = spheres.z[lane] - origin.z;
        let along = dx * direction.x + dy * direction.y + dz * direction.z;
        let ox = dx - direction.x * along;
        let oy = dy - direction.y * along;
        let oz = dz - direction.z * along;
        distance_sq[lane] = ox * ox + oy * oy + oz * oz;
        // Direction and triangle test are off by shares of this distance.
        let apart = dx.abs() + dy.abs() + dz.abs();
        let reach = spheres.radius[lane] + SLACK * (apart + spheres.radius[lane]);
        reach_sq[lane] = reach * reach * (1.0 + SLACK);
        first[lane] = along - reach;
        last[lane] = along + reach;
    }
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    let met = lanes(|lane| {
        !(distance_sq[lane] > reach_sq[lane]) && !(first[lane] > limit) && !(last[lane] < 0.0)
    });
    (met, first)
}

/// The set bits of a mask of lanes, ascending.
pub(super) fn each_lane(mut found: Lanes) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = found.trailing_zeros() as usize;
        found &= found.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    })
}
