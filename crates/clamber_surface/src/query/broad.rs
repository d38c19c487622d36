//! A query against the eight spheres of a node, in f32.
//!
//! Every test errs on the side of a touch: it is widened by more than f32 arithmetic can be off, and NaN counts as a
//! touch. A distance whose square overflows is beyond any reach whose square does not. Squares that underflow do no
//! harm, since every sphere has a radius of at least 2^-56.

use glam::Vec3;

use super::probe::{Probe, Sweep};
use crate::bounds::Spheres;
use crate::geometry::Ray;
use crate::mesh::hierarchy::LANES;

/// Allowance for rounding in f32, as a share of the lengths involved. The tests take some ten roundings of 2^-24. A
/// smaller value risks a missed triangle; a larger one tests more triangles.
pub(super) const SLACK: f32 = 16.0 * f32::EPSILON;

/// The length above which squares overflow in f32, rounded down.
const SQUARE_OVERFLOWS: f32 = 1.8e19;

/// 2^60. Products and sums of the squares of lengths up to this are far from overflow in f32.
const LONG: f32 = (1u64 << 60) as f32;

/// One bit per lane.
pub(super) type LaneMask = u8;

#[cfg_attr(not(unoptimized), inline(always))]
fn lanes(test: impl Fn(usize) -> bool) -> LaneMask {
    // Integers as wide as the numbers compared: otherwise the compiler splits the vectors.
    let mut bits = [0u32; LANES];
    for (lane, bit) in bits.iter_mut().enumerate() {
        *bit = if test(lane) { 1 << lane } else { 0 };
    }
    bits.into_iter().fold(0, |found, bit| found | bit) as LaneMask
}

/// Lanes whose sphere may hold something within the probe's reach, before the probe moves.
pub(super) fn near<const N: usize>(spheres: &Spheres, probe: &Probe<N>) -> LaneMask {
    let (distance_sq, lost) = from_core(spheres, probe);
    let mut reach_sq = [0.0; LANES];
    for lane in 0..LANES {
        let reach = spheres.radius[lane] + probe.reach + lost[lane];
        reach_sq[lane] = reach * reach * (1.0 + SLACK);
    }
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    lanes(|lane| !(distance_sq[lane] > reach_sq[lane]))
}

/// Per lane a lower bound of the distance from a probe's core, before it moves, to the contents of the sphere. For a
/// capsule it is 0 if the sphere is [`LONG`] away, or if the capsule's segment is that long: where a product overflows,
/// the position on the segment is arbitrary.
pub(super) fn distances<const N: usize>(spheres: &Spheres, probe: &Probe<N>) -> [f32; LANES] {
    let (distance_sq, lost) = from_core(spheres, probe);
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

/// Squared distances of the centres from a probe's core, before it moves, and the allowance for rounding in the
/// distances: infinite from [`LONG`] on.
#[cfg_attr(not(unoptimized), inline(always))]
fn from_core<const N: usize>(spheres: &Spheres, probe: &Probe<N>) -> ([f32; LANES], [f32; LANES]) {
    let [a, b] = probe.segment();
    let axis = b - a;
    let length_sq = axis.length_squared();
    let inverse = if length_sq > 0.0 {
        1.0 / length_sq
    } else {
        0.0
    };
    let size = taxicab(axis);
    let [mut distance_sq, mut lost] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let mut dx = spheres.x[lane] - a.x;
        let mut dy = spheres.y[lane] - a.y;
        let mut dz = spheres.z[lane] - a.z;
        if N == 2 {
            let apart = dx.abs() + dy.abs() + dz.abs() + size;
            lost[lane] = SLACK * if apart < LONG { apart } else { f32::INFINITY };
            let along = (dx * axis.x + dy * axis.y + dz * axis.z) * inverse;
            let along = if along > 0.0 { along } else { 0.0 };
            let along = if along < 1.0 { along } else { 1.0 };
            // Rounding in the position is harmless: a point that is off by rounding is hardly farther.
            dx -= axis.x * along;
            dy -= axis.y * along;
            dz -= axis.z * along;
        }
        distance_sq[lane] = dx * dx + dy * dy + dz * dz;
    }
    (distance_sq, lost)
}

/// Lanes whose distance is at most `reach`.
pub(super) fn within(distances: &[f32; LANES], reach: f32) -> LaneMask {
    lanes(|lane| distances[lane] <= reach)
}

/// Lanes whose sphere a ray meets within `limit`, and per lane a lower bound of the distance along the ray to the
/// contents of the sphere.
///
/// Computed from the perpendicular from the centre to the ray, which stays precise far from the origin, where the usual
/// discriminant does not.
pub(super) fn along_ray(spheres: &Spheres, ray: &Ray, limit: f32) -> (LaneMask, [f32; LANES]) {
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
        // The errors of the direction and of the triangle test are shares of this distance.
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

/// Lanes whose contents a sweep may touch up to the time `limit`, and per lane a lower bound of the time of the first
/// touch.
///
/// The contents of a sphere move on straight lines between the two poses. At time t they are within `(1 - t) r0 + t r1`
/// of `(1 - t) c0 + t c1`: at most the larger radius. Relative to that centre the core moves on straight lines as well.
pub(super) fn along<const N: usize, const P: usize>(
    spheres: &[Spheres; P],
    sweep: &Sweep<N>,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let ends = [&spheres[0], &spheres[P - 1]];
    if N == 1 {
        along_line(ends, &sweep.probe, limit)
    } else {
        along_strip(ends, &sweep.probe, limit)
    }
}

/// [`along`] for a swept sphere, by the perpendicular from a bounding sphere's centre to the path of the swept sphere's
/// centre.
fn along_line<const N: usize>(
    [start, end]: [&Spheres; 2],
    probe: &Probe<N>,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let (center, motion) = (probe.ends[0], probe.motions[0]);
    let [mut distance_sq, mut reach_sq, mut first] = [[0.0; LANES]; 3];
    for lane in 0..LANES {
        let (x, y, z) = (
            center.x - start.x[lane],
            center.y - start.y[lane],
            center.z - start.z[lane],
        );
        let (dx, dy, dz) = (
            motion.x + (start.x[lane] - end.x[lane]),
            motion.y + (start.y[lane] - end.y[lane]),
            motion.z + (start.z[lane] - end.z[lane]),
        );
        let length_sq = dx * dx + dy * dy + dz * dz;
        let moves = length_sq > f32::MIN_POSITIVE;
        let inverse = if moves { 1.0 / length_sq } else { 0.0 };
        let closest = -(x * dx + y * dy + z * dz) * inverse;
        let time = if closest > 0.0 { closest } else { 0.0 };
        let time = if time < limit { time } else { limit };
        // Rounding in the time is harmless: a time that is off by rounding is hardly farther.
        let (ox, oy, oz) = (x + dx * time, y + dy * time, z + dz * time);
        distance_sq[lane] = ox * ox + oy * oy + oz * oz;
        let size = x.abs() + y.abs() + z.abs() + taxicab(motion) + radius(start, end, lane);
        let apart = size + dx.abs() + dy.abs() + dz.abs();
        let apart = if apart < LONG { apart } else { f32::INFINITY };
        let reach = radius(start, end, lane) + probe.reach + SLACK * (apart + probe.reach);
        reach_sq[lane] = reach * reach * (1.0 + SLACK);
        let begin = closest - reach * inverse.sqrt();
        first[lane] = if moves {
            begin * (1.0 - SLACK) - SLACK
        } else {
            0.0
        };
    }
    let first = first.map(|time| if time > 0.0 { time } else { 0.0 });
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    let near = lanes(|lane| !(distance_sq[lane] > reach_sq[lane]) && !(first[lane] > limit));
    (near, first)
}

/// Iterations of [`nearest_direction`]. More of them would hardly change the direction.
const ROUNDS: usize = 3;

/// [`along`] for a swept capsule, by two directions: one for the whole path and one for its beginning. The segment's
/// path has four corners. If all of them are farther along a direction than the radii, nothing is touched, however the
/// direction was found.
fn along_strip<const N: usize>(
    [start, end]: [&Spheres; 2],
    probe: &Probe<N>,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let (a, axis) = (probe.ends[0], probe.ends[N - 1] - probe.ends[0]);
    let [of_a, of_b] = [probe.motions[0], probe.motions[N - 1]];
    let longest = taxicab(axis) + taxicab(of_a) + taxicab(of_b);
    let [mut gap, mut reach, mut first] = [[0.0; LANES]; 3];
    for lane in 0..LANES {
        let center = Vec3::new(start.x[lane], start.y[lane], start.z[lane]);
        let shift = center - Vec3::new(end.x[lane], end.y[lane], end.z[lane]);
        let (near, far) = (a - center, a - center + axis);
        let (of_a, of_b) = ((of_a + shift) * limit, (of_b + shift) * limit);
        let corners = [near, far, near + of_a, far + of_b];

        let size = taxicab(near) + taxicab(shift) + longest + radius(start, end, lane);
        let apart = if size < LONG { size } else { f32::INFINITY };
        reach[lane] = radius(start, end, lane) + probe.reach + SLACK * (apart + probe.reach);

        let n = nearest_direction(near, axis, (of_a + of_b) * 0.5);
        gap[lane] = corners
            .map(|corner| n.dot(corner))
            .into_iter()
            .fold(f32::INFINITY, smaller);

        let n = nearest_direction(near, axis, Vec3::ZERO);
        let [near, far, near_later, far_later] = corners.map(|corner| n.dot(corner));
        let begin = smaller(
            until(near, near_later, reach[lane]),
            until(far, far_later, reach[lane]),
        );
        first[lane] = begin * limit * (1.0 - SLACK);
    }
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    let near = lanes(|lane| !(gap[lane] > reach[lane]) && !(first[lane] > limit));
    (near, first)
}

/// Approximate unit direction from the origin to the nearest point of the parallelogram with a corner at `corner`; zero
/// if that point is the origin.
fn nearest_direction(corner: Vec3, side: Vec3, other: Vec3) -> Vec3 {
    let [inverse, inverse_of_other] = [side, other].map(|side| {
        let length_sq = side.length_squared();
        if length_sq > f32::MIN_POSITIVE {
            1.0 / length_sq
        } else {
            0.0
        }
    });
    let mut nearest = corner + side * 0.5;
    let mut along = 0.0;
    for _ in 0..ROUNDS {
        along = to_unit(-(nearest - other * along).dot(other) * inverse_of_other);
        let line = corner + other * along;
        nearest = line + side * to_unit(-line.dot(side) * inverse);
    }
    let length_sq = nearest.length_squared();
    if length_sq > f32::MIN_POSITIVE {
        nearest * (1.0 / length_sq.sqrt())
    } else {
        Vec3::ZERO
    }
}

/// The share of the way from `from` to `to` before which a number is above `level`; above 1 if it stays above, 0 if it
/// does not start above.
fn until(from: f32, to: f32, level: f32) -> f32 {
    let share = (from - level) / (from - to);
    let share = if to < level { share } else { 2.0 };
    if from > level { share } else { 0.0 }
}

fn to_unit(share: f32) -> f32 {
    let share = if share > 0.0 { share } else { 0.0 };
    if share < 1.0 { share } else { 1.0 }
}

fn smaller(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

fn radius(start: &Spheres, end: &Spheres, lane: usize) -> f32 {
    let (start, end) = (start.radius[lane], end.radius[lane]);
    if start < end { end } else { start }
}

fn taxicab(v: Vec3) -> f32 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Lanes whose contents may enter the box between two poses. The contents stay in the box around the spheres at both
/// poses.
pub(super) fn near_box([start, end]: &[Spheres; 2], [low, high]: [[f32; 3]; 2]) -> LaneMask {
    let mut beyond = [false; LANES];
    for (axis, (first, last)) in axes(start).into_iter().zip(axes(end)).enumerate() {
        for lane in 0..LANES {
            let reach = |spheres: &Spheres, x: f32| {
                spheres.radius[lane] + SLACK * (x.abs() + spheres.radius[lane])
            };
            let (x, y) = (first[lane], last[lane]);
            let (at_x, at_y) = (reach(start, x), reach(end, y));
            // Comparisons with NaN are false, so NaN touches.
            beyond[lane] |= (x + at_x < low[axis]) & (y + at_y < low[axis]);
            beyond[lane] |= (x - at_x > high[axis]) & (y - at_y > high[axis]);
        }
    }
    lanes(|lane| !beyond[lane])
}

fn axes(spheres: &Spheres) -> [&[f32; LANES]; 3] {
    [&spheres.x, &spheres.y, &spheres.z]
}
