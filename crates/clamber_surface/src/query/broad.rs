//! A query against the eight bounds of a node, in f32.
//!
//! Every test errs on the side of a touch: it is widened by more than f32 arithmetic can be off, and NaN counts as a
//! touch. A distance whose square overflows is beyond any reach whose square does not. Squares that underflow do no
//! harm, since every sphere has a radius of at least 2^-56, and distances from boxes an allowance.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use glam::Vec3;

use super::probe::{Probe, Sweep};
use crate::bounds::{Bounds, Boxes, Spheres};
use crate::geometry::Ray;
use crate::geometry::triangle::ShearedRay;
use crate::mesh::hierarchy::LANES;

/// Allowance for rounding in f32, as a share of the lengths involved. The tests take some ten roundings of 2^-24. A
/// smaller value risks a missed triangle; a larger one tests more triangles.
pub(super) const SLACK: f32 = 16.0 * f32::EPSILON;

/// The length above which squares overflow in f32, rounded down.
const SQUARE_OVERFLOWS: f32 = 1.8e19;

/// 2^-62. Squares of shorter lengths lose digits in f32, or underflow.
const SQUARE_UNDERFLOWS: f32 = 1.0 / (1u64 << 62) as f32;

/// 2^60. Products and sums of the squares of lengths up to this are far from overflow in f32.
const LONG: f32 = (1u64 << 60) as f32;

/// One bit per lane.
pub(super) type LaneMask = u8;

/// A number per lane.
type Lanes<S> = f32x8<S>;

#[cfg_attr(not(unoptimized), inline(always))]
fn load<S: Simd>(simd: S, lanes: &[f32; LANES]) -> Lanes<S> {
    Lanes::<S>::simd_from(simd, *lanes)
}

/// A point per lane, less a point that all share.
#[cfg_attr(not(unoptimized), inline(always))]
fn centers_from<S: Simd>(simd: S, spheres: &Spheres, origin: Vec3) -> [Lanes<S>; 3] {
    [
        load(simd, &spheres.x) - origin.x,
        load(simd, &spheres.y) - origin.y,
        load(simd, &spheres.z) - origin.z,
    ]
}

#[cfg_attr(not(unoptimized), inline(always))]
fn dot<S: Simd>([x, y, z]: [Lanes<S>; 3], [a, b, c]: [Lanes<S>; 3]) -> Lanes<S> {
    x * a + y * b + z * c
}

/// The sums of absolute coordinates.
#[cfg_attr(not(unoptimized), inline(always))]
fn sizes<S: Simd>([x, y, z]: [Lanes<S>; 3]) -> Lanes<S> {
    x.abs() + y.abs() + z.abs()
}

/// The larger number, by comparison; `b` where either is NaN.
#[cfg_attr(not(unoptimized), inline(always))]
fn larger<S: Simd>(a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    a.simd_gt(b).select(a, b)
}

/// The smaller number, by comparison; `b` where either is NaN.
#[cfg_attr(not(unoptimized), inline(always))]
fn less<S: Simd>(a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    a.simd_lt(b).select(a, b)
}

/// The lanes that are not in `beyond`.
#[cfg_attr(not(unoptimized), inline(always))]
fn others<S: Simd>(beyond: mask32x8<S>) -> LaneMask {
    !(beyond.to_bitmask() as LaneMask)
}

/// Lanes whose bound may hold something within the probe's reach, before the probe moves.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn near<S: Simd, const N: usize>(
    simd: S,
    bounds: &Bounds,
    probe: &Probe<N>,
) -> LaneMask {
    let spheres = match bounds {
        Bounds::Spheres(spheres) => spheres,
        Bounds::Boxes(boxes) => {
            let reach = probe.reach * (1.0 + SLACK) + SQUARE_UNDERFLOWS;
            return others(
                square_from_box(simd, boxes, probe).simd_gt(Lanes::<S>::splat(simd, reach * reach)),
            );
        }
    };
    let (distance_sq, lost) = from_core(simd, spheres, probe);
    let reach = load(simd, &spheres.radius) + probe.reach + lost;
    others(distance_sq.simd_gt(reach * reach * (1.0 + SLACK)))
}

/// Per lane a lower bound of the distance from a probe's core, before it moves, to the contents of the sphere. For a
/// capsule it is 0 if the sphere is [`LONG`] away, or if the capsule's segment is that long: where a product overflows,
/// the position on the segment is arbitrary.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn distances<S: Simd, const N: usize>(
    simd: S,
    bounds: &Bounds,
    probe: &Probe<N>,
) -> [f32; LANES] {
    let farthest = Lanes::<S>::splat(simd, SQUARE_OVERFLOWS);
    let spheres = match bounds {
        Bounds::Spheres(spheres) => spheres,
        Bounds::Boxes(boxes) => {
            let apart = square_from_box(simd, boxes, probe).sqrt();
            let apart = less(apart, farthest) * (1.0 - SLACK) - SQUARE_UNDERFLOWS;
            return *larger(apart, Lanes::<S>::splat(simd, 0.0));
        }
    };
    let (distance_sq, lost) = from_core(simd, spheres, probe);
    let apart = less(distance_sq.sqrt(), farthest);
    let radius = load(simd, &spheres.radius);
    let gap = apart * (1.0 - SLACK) - radius * (1.0 + SLACK) - lost;
    *larger(gap, Lanes::<S>::splat(simd, 0.0))
}

/// Squared distances of the boxes from the box around a probe's core, before it moves.
#[cfg_attr(not(unoptimized), inline(always))]
fn square_from_box<S: Simd, const N: usize>(simd: S, boxes: &Boxes, probe: &Probe<N>) -> Lanes<S> {
    let [a, b] = probe.segment();
    let (first, last) = (a.min(b), a.max(b));
    let zero = Lanes::<S>::splat(simd, 0.0);
    let mut square = zero;
    for axis in 0..3 {
        let below = load(simd, &boxes.low[axis]) - last[axis];
        let above = Lanes::<S>::splat(simd, first[axis]) - load(simd, &boxes.high[axis]);
        let apart = larger(larger(below, above), zero);
        square += apart * apart;
    }
    square
}

/// Squared distances of the centres from a probe's core, before it moves, and the allowance for rounding in the
/// distances: infinite from [`LONG`] on.
#[cfg_attr(not(unoptimized), inline(always))]
fn from_core<S: Simd, const N: usize>(
    simd: S,
    spheres: &Spheres,
    probe: &Probe<N>,
) -> (Lanes<S>, Lanes<S>) {
    let [a, b] = probe.segment();
    let number = |x: f32| Lanes::<S>::splat(simd, x);
    let mut from = centers_from(simd, spheres, a);
    let mut lost = number(0.0);
    if N == 2 {
        let axis = b - a;
        let length_sq = axis.length_squared();
        let inverse = if length_sq > 0.0 {
            1.0 / length_sq
        } else {
            0.0
        };
        let apart = sizes(from) + taxicab(axis);
        let apart = apart
            .simd_lt(number(LONG))
            .select(apart, number(f32::INFINITY));
        lost = apart * SLACK;
        let along = (from[0] * axis.x + from[1] * axis.y + from[2] * axis.z) * inverse;
        let along = less(larger(along, number(0.0)), number(1.0));
        // Rounding in the position is harmless: a point that is off by rounding is hardly farther.
        from[0] -= along * axis.x;
        from[1] -= along * axis.y;
        from[2] -= along * axis.z;
    }
    (dot(from, from), lost)
}

/// Lanes whose distance is at most `reach`.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn within<S: Simd>(simd: S, distances: &[f32; LANES], reach: f32) -> LaneMask {
    let reach = Lanes::<S>::splat(simd, reach);
    load(simd, distances).simd_le(reach).to_bitmask() as LaneMask
}

/// Lanes whose sphere a ray meets within `limit`, and per lane a lower bound of the distance along the ray to the
/// contents of the sphere.
///
/// Computed from the perpendicular from the centre to the ray, which stays precise far from the origin, where the usual
/// discriminant does not.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn along_ray<S: Simd>(
    simd: S,
    bounds: &Bounds,
    ray: &Ray,
    sheared: &ShearedRay,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let spheres = match bounds {
        Bounds::Spheres(spheres) => spheres,
        Bounds::Boxes(boxes) => return along_sheared(simd, boxes, sheared, limit),
    };
    let direction = ray.direction();
    let from = centers_from(simd, spheres, ray.origin());
    let along = from[0] * direction.x + from[1] * direction.y + from[2] * direction.z;
    let aside = [
        from[0] - along * direction.x,
        from[1] - along * direction.y,
        from[2] - along * direction.z,
    ];
    let radius = load(simd, &spheres.radius);
    // The errors of the direction and of the triangle test are shares of this distance.
    let reach = radius + (sizes(from) + radius) * SLACK;
    let (first, last) = (along - reach, along + reach);
    let beyond = dot(aside, aside).simd_gt(reach * reach * (1.0 + SLACK))
        | first.simd_gt(Lanes::<S>::splat(simd, limit))
        | last.simd_lt(Lanes::<S>::splat(simd, 0.0));
    (others(beyond), *larger(first, Lanes::<S>::splat(simd, 0.0)))
}

/// [`along_ray`] for boxes: [`ShearedRay::may_meet_box`] in every lane.
#[cfg_attr(not(unoptimized), inline(always))]
fn along_sheared<S: Simd>(
    simd: S,
    boxes: &Boxes,
    ray: &ShearedRay,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let origin = ray.origin.to_array();
    let number = |x: f32| Lanes::<S>::splat(simd, x);
    let zero = number(0.0);
    let (mut middles, mut halves) = ([zero; 3], [zero; 3]);
    for (k, axis) in ray.axes.into_iter().enumerate() {
        let low = (load(simd, &boxes.low[axis % 3]) - origin[axis % 3]) * 0.5;
        let high = (load(simd, &boxes.high[axis % 3]) - origin[axis % 3]) * 0.5;
        (middles[k], halves[k]) = (low + high, high - low);
    }
    let [x, y, z] = middles;
    let sizes = sizes(middles) + halves[0] + halves[1] + halves[2];
    let slack = sizes * SLACK + f32::MIN_POSITIVE;
    let [shear_x, shear_y, scale] = ray.shear;
    let beside_x = (x - z * shear_x).abs();
    let beside_x = beside_x.simd_gt(halves[0] + halves[2] * shear_x.abs() + slack);
    let beside_y = (y - z * shear_y).abs();
    let beside_y = beside_y.simd_gt(halves[1] + halves[2] * shear_y.abs() + slack);
    let (along, reach) = (z * scale, (halves[2] + slack) * scale.abs());
    let first = along - reach;
    let beyond = beside_x | beside_y | (along + reach).simd_lt(zero) | first.simd_gt(number(limit));
    (others(beyond), *larger(first, zero))
}

/// Lanes whose contents a sweep may touch up to the time `limit`, and per lane a lower bound of the time of the first
/// touch.
///
/// The contents of a sphere move on straight lines between the two poses. At time t they are within `(1 - t) r0 + t r1`
/// of `(1 - t) c0 + t c1`: at most the larger radius. Relative to that centre the core moves on straight lines as well.
/// `path` is the sweep's box.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn along<S: Simd, const N: usize, const P: usize>(
    simd: S,
    bounds: [&Bounds; P],
    sweep: &Sweep<N>,
    path: [[f32; 3]; 2],
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let ends = [bounds[0], bounds[P - 1]];
    let in_path = in_boxes(simd, ends, path);
    let is_part = P == 2 && !sweep.span.is_whole();
    if let ([Bounds::Spheres(start), Bounds::Spheres(end)], false) = (ends, is_part) {
        return along_spheres(simd, [start, end], sweep, limit);
    }
    let [mut start, mut end] = [ends[0].spheres(simd), ends[1].spheres(simd)];
    if is_part {
        sweep.span.spheres([&mut start, &mut end]);
    }
    let (near, first) = along_spheres(simd, [&start, &end], sweep, limit);
    (near & in_path, first)
}

#[cfg_attr(not(unoptimized), inline(always))]
fn along_spheres<S: Simd, const N: usize>(
    simd: S,
    spheres: [&Spheres; 2],
    sweep: &Sweep<N>,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    if N == 1 {
        along_line(simd, spheres, &sweep.probe, limit)
    } else {
        along_strip(spheres, &sweep.probe, limit)
    }
}

/// Lanes that the boxes at both ends of a motion do not keep out of the box from `low` to `high`: all, unless both ends
/// have boxes.
#[cfg_attr(not(unoptimized), inline(always))]
fn in_boxes<S: Simd>(simd: S, ends: [&Bounds; 2], [low, high]: [[f32; 3]; 2]) -> LaneMask {
    let [Bounds::Boxes(start), Bounds::Boxes(end)] = ends else {
        return LaneMask::MAX;
    };
    let mut beyond = mask32x8::splat(simd, false);
    for axis in 0..3 {
        let (low, high) = (
            Lanes::<S>::splat(simd, low[axis]),
            Lanes::<S>::splat(simd, high[axis]),
        );
        beyond |=
            load(simd, &start.high[axis]).simd_lt(low) & load(simd, &end.high[axis]).simd_lt(low);
        beyond |=
            load(simd, &start.low[axis]).simd_gt(high) & load(simd, &end.low[axis]).simd_gt(high);
    }
    others(beyond)
}

/// [`along`] for a swept sphere, by the perpendicular from a bounding sphere's centre to the path of the swept sphere's
/// centre.
#[cfg_attr(not(unoptimized), inline(always))]
fn along_line<S: Simd, const N: usize>(
    simd: S,
    [start, end]: [&Spheres; 2],
    probe: &Probe<N>,
    limit: f32,
) -> (LaneMask, [f32; LANES]) {
    let (center, motion) = (probe.ends[0], probe.motions[0]);
    let number = |x: f32| Lanes::<S>::splat(simd, x);
    let zero = number(0.0);
    let limit = number(limit);
    let centers = |spheres: &Spheres| {
        [
            load(simd, &spheres.x),
            load(simd, &spheres.y),
            load(simd, &spheres.z),
        ]
    };
    let ([x, y, z], [end_x, end_y, end_z]) = (centers(start), centers(end));
    let from = [
        number(center.x) - x,
        number(center.y) - y,
        number(center.z) - z,
    ];
    let way = [
        (x - end_x) + motion.x,
        (y - end_y) + motion.y,
        (z - end_z) + motion.z,
    ];
    let length_sq = dot(way, way);
    let moves = length_sq.simd_gt(number(f32::MIN_POSITIVE));
    let inverse = moves.select(number(1.0) / length_sq, zero);
    let closest = -dot(from, way) * inverse;
    let time = less(larger(closest, zero), limit);
    // Rounding in the time is harmless: a time that is off by rounding is hardly farther.
    let nearest = [
        from[0] + way[0] * time,
        from[1] + way[1] * time,
        from[2] + way[2] * time,
    ];
    let radius = larger(load(simd, &start.radius), load(simd, &end.radius));
    let apart = sizes(from) + taxicab(motion) + radius + sizes(way);
    let apart = apart
        .simd_lt(number(LONG))
        .select(apart, number(f32::INFINITY));
    let reach = radius + probe.reach + (apart + probe.reach) * SLACK;
    let begin = closest - reach * inverse.sqrt();
    let first = moves.select(begin * (1.0 - SLACK) - SLACK, zero);
    let first = larger(first, zero);
    let beyond =
        dot(nearest, nearest).simd_gt(reach * reach * (1.0 + SLACK)) | first.simd_gt(limit);
    (others(beyond), *first)
}

/// Iterations of [`nearest_direction`]. More of them would hardly change the direction.
const ROUNDS: usize = 3;

#[cfg_attr(not(unoptimized), inline(always))]
fn lanes(test: impl Fn(usize) -> bool) -> LaneMask {
    // Integers as wide as the numbers compared: otherwise the compiler splits the vectors.
    let mut bits = [0u32; LANES];
    for (lane, bit) in bits.iter_mut().enumerate() {
        *bit = if test(lane) { 1 << lane } else { 0 };
    }
    bits.into_iter().fold(0, |found, bit| found | bit) as LaneMask
}

/// [`along`] for a swept capsule, by two directions: one for the whole path and one for its beginning. The segment's
/// path has four corners. If all of them are farther along a direction than the radii, nothing is touched, however the
/// direction was found.
#[cfg_attr(not(unoptimized), inline(always))]
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
        let begin = begin * limit * (1.0 - SLACK);
        first[lane] = if begin > 0.0 { begin } else { 0.0 };
    }
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must touch")]
    let near = lanes(|lane| !(gap[lane] > reach[lane]) && !(first[lane] > limit));
    (near, first)
}

/// Approximate unit direction from the origin to the nearest point of the parallelogram with a corner at `corner`; zero
/// if that point is the origin.
#[cfg_attr(not(unoptimized), inline(always))]
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

/// Lanes whose contents may enter the box between two poses. The contents stay in the box around their bounds at both
/// poses.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn near_box<S: Simd>(
    simd: S,
    ends: [&Bounds; 2],
    [low, high]: [[f32; 3]; 2],
) -> LaneMask {
    let [start, end] = [ends[0].spheres(simd), ends[1].spheres(simd)];
    let mut beyond = [false; LANES];
    for (axis, (first, last)) in axes(&start).into_iter().zip(axes(&end)).enumerate() {
        for lane in 0..LANES {
            let reach = |spheres: &Spheres, x: f32| {
                spheres.radius[lane] + SLACK * (x.abs() + spheres.radius[lane])
            };
            let (x, y) = (first[lane], last[lane]);
            let (at_x, at_y) = (reach(&start, x), reach(&end, y));
            // Comparisons with NaN are false, so NaN touches.
            beyond[lane] |= (x + at_x < low[axis]) & (y + at_y < low[axis]);
            beyond[lane] |= (x - at_x > high[axis]) & (y - at_y > high[axis]);
        }
    }
    lanes(|lane| !beyond[lane]) & in_boxes(simd, ends, [low, high])
}

fn axes(spheres: &Spheres) -> [&[f32; LANES]; 3] {
    [&spheres.x, &spheres.y, &spheres.z]
}
