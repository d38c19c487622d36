//! The point of a triangle nearest to a point.
//!
//! Takes the nearest of four candidates: the foot of the perpendicular, if it falls inside, and the nearest point of
//! each edge. The usual decision by Voronoi regions (Ericson 2004, *Real-Time Collision Detection*, 5.1.5) would trust
//! the sign of one number. Each candidate here is a point of the triangle whose distance is measured, so the result is
//! farther than the nearest point by at most rounding error. Slivers lose no precision, and a triangle of zero area
//! gives the result of the segment or point that it is.

use glam::Vec3;

use super::TrianglePoint;
use super::candidate::{Candidate, between, fraction};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;
use crate::geometry::widen;

/// The point of triangle `corners` nearest to `p`.
pub(crate) fn closest_point(corners: [Vec3; 3], p: Vec3) -> TrianglePoint {
    let p = widen(p);
    nearest_to_origin(corners.map(|corner| Vector3::from(widen(corner) - p))).into()
}

/// The point of a triangle nearest to the origin. Callers subtract the query's point first, before anything is
/// multiplied.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn nearest_to_origin<L: Lanes>(corners: [Vector3<L>; 3]) -> Candidate<L> {
    let [ab, bc, ca] = edges(corners);
    let [ab, bc, ca] = [ab.nearest(), bc.nearest(), ca.nearest()];
    on_edges([ab, bc, ca]).or_nearer(foot(corners))
}

/// A point of an edge: its position, from 0 at the edge's first corner to 1 at its second, and its distance.
#[derive(Clone, Copy)]
pub(super) struct OnEdge<L> {
    pub(super) t: L,
    pub(super) distance: L,
}

/// The nearest of three points, one on each edge.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn on_edges<L: Lanes>([ab, bc, ca]: [OnEdge<L>; 3]) -> Candidate<L> {
    let (zero, one) = (ab.t.splat(0.0), ab.t.splat(1.0));
    let ab = Candidate {
        weights: [one - ab.t, ab.t, zero],
        distance: ab.distance,
    };
    let bc = Candidate {
        weights: [zero, one - bc.t, bc.t],
        distance: bc.distance,
    };
    let ca = Candidate {
        weights: [ca.t, zero, one - ca.t],
        distance: ca.distance,
    };
    ab.or_nearer(bc).or_nearer(ca)
}

/// Edges a to b, b to c, c to a.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn edges<L: Lanes>([a, b, c]: [Vector3<L>; 3]) -> [Edge<L>; 3] {
    [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)]
}

/// An edge that starts at its lexicographically smaller end. Two triangles that share it then compute the same bits for
/// the distance, so a tie between them is exact.
#[derive(Clone, Copy)]
pub(super) struct Edge<L: Lanes> {
    pub(super) ends: [Vector3<L>; 2],
    /// True if the smaller end is the second corner.
    pub(super) swapped: L::Mask,
}

impl<L: Lanes> Edge<L> {
    #[cfg_attr(not(unoptimized), inline(always))]
    fn new(a: Vector3<L>, b: Vector3<L>) -> Self {
        let swapped = b.precedes(a);
        Self {
            ends: [
                Vector3::select(swapped, b, a),
                Vector3::select(swapped, a, b),
            ],
            swapped,
        }
    }

    /// The edge's point nearest to the origin.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn nearest(self) -> OnEdge<L> {
        let [low, high] = self.ends;
        let along = high - low;
        let t = fraction(-low.dot(along), along.length_squared());
        OnEdge {
            t: L::select(self.swapped, t.splat(1.0) - t, t),
            distance: between(self.ends, t).length(),
        }
    }
}

/// The foot of the perpendicular from the origin, if it falls inside; else a candidate at infinite distance.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn foot<L: Lanes>(corners: [Vector3<L>; 3]) -> Candidate<L> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let [x, y, z] = volumes(corners, normal);
    let sum = x + y + z;
    let zero = sum.splat(0.0);
    let inside = zero.at_most(x) & zero.at_most(y) & zero.at_most(z) & zero.less(sum);
    let weights = [x / sum, y / sum, z / sum];
    Candidate {
        weights,
        distance: weighted(corners, weights).length(),
    }
    .only_where(inside)
}

/// Corner weights of the foot of the perpendicular from the origin, each times the sum of all three.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn volumes<L: Lanes>([a, b, c]: [Vector3<L>; 3], normal: Vector3<L>) -> [L; 3] {
    [
        normal.dot(b.cross(c)),
        normal.dot(c.cross(a)),
        normal.dot(a.cross(b)),
    ]
}

/// The point with the given weights.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn weighted<L: Lanes>([a, b, c]: [Vector3<L>; 3], [x, y, z]: [L; 3]) -> Vector3<L> {
    a * x + b * y + c * z
}
