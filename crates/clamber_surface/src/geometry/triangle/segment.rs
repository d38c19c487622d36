//! The point of a triangle nearest to a segment, the axis of a capsule.
//!
//! The nearest pair of a segment and a triangle lies at an edge (Ericson 2004, 5.1.9), at the foot of one end on the
//! face, or where the segment crosses the face. As for [points](super::point), each of these pairs is computed and its
//! distance measured, and the nearest is taken. So no decision by sign can make the result worse than rounding error.

use glam::{DVec3, Vec3};

use super::TrianglePoint;
use super::candidate::{Candidate, between, fraction};
use super::point::{Edge, OnEdge, edges, foot, nearest_to_origin, on_edges, volumes, weighted};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;
use crate::geometry::widen;

/// Largest distance, as a share of the lengths involved, that counts as a crossing where the segment passes through the
/// face: 32 roundings of 2^-53. If it were smaller, a crossing would report rounding error as its distance; if it were
/// larger, a gap would count as a crossing.
const TOUCHING: f64 = 1.0 / (1u64 << 48) as f64;

/// The point of triangle `corners` nearest to the segment from `a` to `b`, with its distance from the segment. If they
/// cross, the distance is 0 and the point is the crossing point (in slivers, the distance may be the rounding error
/// that the [module](super) states).
///
/// The result has the same bits with the ends swapped. If the ends are equal, it has the bits of
/// [`closest_point`](super::closest_point).
pub(crate) fn closest_to_segment(corners: [Vec3; 3], a: Vec3, b: Vec3) -> TrianglePoint {
    let [a, b] = ordered(a, b).map(widen);
    let from_a = corners.map(|corner| Vector3::from(widen(corner) - a));
    let from_b = corners.map(|corner| Vector3::from(widen(corner) - b));
    nearest_to_segment(from_a, from_b, (b - a).into()).into()
}

/// [`closest_to_segment`] for coordinates in f64; the ends may be the same point.
pub(crate) fn nearest_to_axis(corners: [DVec3; 3], [a, b]: [DVec3; 2]) -> TrianglePoint {
    let from = |end: DVec3| corners.map(|corner| Vector3::from(corner - end));
    if a == b {
        nearest_to_origin(from(a)).into()
    } else {
        nearest_to_segment(from(a), from(b), (b - a).into()).into()
    }
}

/// The two points, the lexicographically smaller one first.
pub(super) fn ordered(a: Vec3, b: Vec3) -> [Vec3; 2] {
    if b.to_array() < a.to_array() {
        [b, a]
    } else {
        [a, b]
    }
}

/// The point nearest to a segment from the origin to `axis`, given the corners relative to the
/// segment's start and to its end.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn nearest_to_segment<L: Lanes>(
    from_start: [Vector3<L>; 3],
    from_end: [Vector3<L>; 3],
    axis: Vector3<L>,
) -> Candidate<L> {
    let [ab, bc, ca] = edges(from_start);
    let [ab, bc, ca] = [
        edge_to_segment(ab, axis),
        edge_to_segment(bc, axis),
        edge_to_segment(ca, axis),
    ];
    on_edges([ab, bc, ca])
        .or_nearer(foot(from_start))
        .or_nearer(on_face(from_start, from_end, axis))
}

/// The point of an edge nearest to the segment.
///
/// Three steps, each clamped: the edge's point nearest to the segment's line, the segment's point nearest to that
/// point, and the edge's point nearest to that. Unless the lines are nearly parallel, the first step finds the result.
/// For nearly parallel lines it may be far off *along* both, which the other two steps correct.
#[cfg_attr(not(unoptimized), inline(always))]
fn edge_to_segment<L: Lanes>(edge: Edge<L>, axis: Vector3<L>) -> OnEdge<L> {
    let [low, high] = edge.ends;
    // From the cross product: a difference of squares would keep only half the digits.
    let across = (high - low).cross(axis);
    let t = fraction(-low.cross(axis).dot(across), across.length_squared());
    let near = point_of_axis(axis, nearest_on_axis(axis, between(edge.ends, t)));
    Edge {
        ends: [low - near, high - near],
        swapped: edge.swapped,
    }
    .nearest()
}

/// The point where the segment's line passes through the face's plane, clamped to the segment and to the face: the
/// crossing or, at a clamped end, the foot of that end. A segment parallel to the plane has no such point. All of its
/// points are equally far from the plane, so the foot of its start is enough.
///
/// The normal of a sliver of height h and length 1 is off by 2^-53 / h, and so is the first guess. One step of Newton's
/// method from that guess squares the error.
#[cfg_attr(not(unoptimized), inline(always))]
fn on_face<L: Lanes>(
    corners: [Vector3<L>; 3],
    from_end: [Vector3<L>; 3],
    axis: Vector3<L>,
) -> Candidate<L> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let start = normal.dot(a);
    let apart = start - normal.dot(from_end[0]);
    let zero = apart.splat(0.0);
    let slanted = apart.less(zero) | zero.less(apart);

    let s = (start / apart).clamp_to_unit();
    let guess = point_of_axis(axis, s);
    let [x, y, z] = to_face(volumes([a - guess, b - guess, c - guess], normal));
    let met = weighted(corners, [x, y, z]);

    let s = (s - normal.dot(guess - met) / apart).clamp_to_unit();
    let near = point_of_axis(axis, s);
    let off = near - met;
    let normal_sq = normal.length_squared();
    let weights = to_face([
        x + normal.dot(off.cross(b - c)) / normal_sq,
        y + normal.dot(off.cross(c - a)) / normal_sq,
        z + normal.dot(off.cross(a - b)) / normal_sq,
    ]);
    let distance = (weighted(corners, weights) - near).length();

    let reach_sq = a.length_squared() + (b - a).length_squared() + axis.length_squared();
    let touching = (distance * distance).at_most(reach_sq * zero.splat(TOUCHING * TOUCHING));
    Candidate {
        weights,
        distance: L::select(touching, zero, distance),
    }
    .only_where(slanted)
}

/// Clamps weights to the face: none negative, sum 1.
#[cfg_attr(not(unoptimized), inline(always))]
fn to_face<L: Lanes>([x, y, z]: [L; 3]) -> [L; 3] {
    let zero = x.splat(0.0);
    let x = L::select(zero.less(x), x, zero);
    let y = L::select(zero.less(y), y, zero);
    let z = L::select(zero.less(z), z, zero);
    let sum = x + y + z;
    [x / sum, y / sum, z / sum]
}

/// Position, 0..=1, of the point nearest to `p` on the segment from the origin to `axis`.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn nearest_on_axis<L: Lanes>(axis: Vector3<L>, p: Vector3<L>) -> L {
    fraction(p.dot(axis), axis.length_squared())
}

#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn point_of_axis<L: Lanes>(axis: Vector3<L>, s: L) -> Vector3<L> {
    let zero = s.splat(0.0);
    let origin = Vector3 {
        x: zero,
        y: zero,
        z: zero,
    };
    between([origin, axis], s)
}
