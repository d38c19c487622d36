//! A moving sphere or capsule against the eight moving spheres of a node, in f32.
//!
//! What a sphere holds at either end of the motion moves on straight lines, so at time t it is within
//! `(1 - t) r0 + t r1` of `(1 - t) c0 + t c1`: at most the larger radius. Relative to that centre the
//! core moves on straight lines as well.
//!
//! As in [the parent's](super::super::broad), every test errs on the side of a touch.

use glam::Vec3;

use super::super::broad::{LONG, Lanes, SLACK, lanes};
use super::Sweep;
use crate::mesh::hierarchy::LANES;
use crate::surface::bounds::Spheres;

/// Lanes of which anything may be touched up to the time `limit`, and per lane at most the time at
/// which that begins.
pub(super) fn along<const N: usize>(
    spheres: &[Spheres; 2],
    sweep: &Sweep<N>,
    limit: f32,
) -> (Lanes, [f32; LANES]) {
    if N == 1 {
        along_line(spheres, sweep, limit)
    } else {
        along_strip(spheres, sweep, limit)
    }
}

/// By the perpendicular from a sphere's centre to the path of the swept sphere's centre.
fn along_line<const N: usize>(
    [start, end]: &[Spheres; 2],
    sweep: &Sweep<N>,
    limit: f32,
) -> (Lanes, [f32; LANES]) {
    let (center, motion) = (sweep.ends[0], sweep.motions[0]);
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
        // Any time up to the limit will do: one that is off by rounding is hardly farther.
        let (ox, oy, oz) = (x + dx * time, y + dy * time, z + dz * time);
        distance_sq[lane] = ox * ox + oy * oy + oz * oz;
        let size = x.abs() + y.abs() + z.abs() + taxicab(motion) + radius(start, end, lane);
        let apart = size + dx.abs() + dy.abs() + dz.abs();
        let apart = if apart < LONG { apart } else { f32::INFINITY };
        let reach = radius(start, end, lane) + sweep.reach + SLACK * (apart + sweep.reach);
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

/// Rounds of [`nearest_direction`]: more would turn the direction by little.
const ROUNDS: usize = 3;

/// By one direction for all of the path, and one for its beginning: what is farther than the radii
/// along either, at all four corners that the segment has on its path, is not touched, however the
/// direction was found.
fn along_strip<const N: usize>(
    [start, end]: &[Spheres; 2],
    sweep: &Sweep<N>,
    limit: f32,
) -> (Lanes, [f32; LANES]) {
    let (a, axis) = (sweep.ends[0], sweep.ends[N - 1] - sweep.ends[0]);
    let [of_a, of_b] = [sweep.motions[0], sweep.motions[N - 1]];
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
        reach[lane] = radius(start, end, lane) + sweep.reach + SLACK * (apart + sweep.reach);

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

/// About the unit direction from the origin to the nearest point of the parallelogram with a corner at
/// `corner`; zero where that is the origin.
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

/// The share of the way from `from` to `to` before which a number is above `level`; beyond 1 if it
/// stays so.
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
