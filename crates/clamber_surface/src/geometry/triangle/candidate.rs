//! Candidates for the nearest point of a triangle, and the choice between two of them.

use glam::DVec3;

use super::TrianglePoint;
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// A point of the triangle with its measured distance from the query, in each lane.
#[derive(Clone, Copy)]
pub(super) struct Candidate<L> {
    /// Weights of the corners.
    pub(super) weights: [L; 3],
    pub(super) distance: L,
}

impl<L: Lanes> Candidate<L> {
    /// The nearer of the two; `self` if both are equally near.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn or_nearer(self, other: Self) -> Self {
        let nearer = other.distance.less(self.distance);
        let [a, b, c] = self.weights;
        let [other_a, other_b, other_c] = other.weights;
        Self {
            weights: [
                L::select(nearer, other_a, a),
                L::select(nearer, other_b, b),
                L::select(nearer, other_c, c),
            ],
            distance: L::select(nearer, other.distance, self.distance),
        }
    }

    /// Sets the distance to infinity where not `valid`, so that every other candidate is nearer.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn only_where(self, valid: L::Mask) -> Self {
        let infinity = self.distance.splat(f64::INFINITY);
        Self {
            distance: L::select(valid, self.distance, infinity),
            ..self
        }
    }
}

impl From<Candidate<f64>> for TrianglePoint {
    fn from(candidate: Candidate<f64>) -> Self {
        Self {
            barycentric: DVec3::from_array(candidate.weights),
            distance: candidate.distance,
        }
    }
}

/// `numerator / denominator` clamped to 0..1; 0 where the denominator is not positive.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn fraction<L: Lanes>(numerator: L, denominator: L) -> L {
    let zero = numerator.splat(0.0);
    let positive = zero.less(denominator);
    L::select(positive, (numerator / denominator).clamp_to_unit(), zero)
}

/// The point at `t` between two ends. For `t` above 0.5 it is computed from the second end, so that t = 1 gives that
/// end exactly.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn between<L: Lanes>(ends: [Vector3<L>; 2], t: L) -> Vector3<L> {
    let [start, end] = ends;
    let along = end - start;
    let (half, one) = (t.splat(0.5), t.splat(1.0));
    Vector3::select(t.at_most(half), start + along * t, end - along * (one - t))
}
