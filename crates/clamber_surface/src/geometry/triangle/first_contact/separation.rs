//! The nearest points of triangle and core at a time, and the direction between them.

use super::ROUNDED_DOWN;
use super::gaps::taxicab;
use super::path::Path;
use crate::geometry::lanes::Lanes;
use crate::geometry::triangle::point::{nearest_to_origin, weighted};
use crate::geometry::triangle::segment::{nearest_on_axis, nearest_to_segment, point_of_axis};
use crate::geometry::vector3::Vector3;

/// The nearest points of triangle and core.
#[derive(Clone, Copy)]
pub(super) struct Separation<L> {
    /// Corner weights of the triangle's nearest point.
    pub(super) weights: [L; 3],
    /// Vector from the triangle's nearest point to the core's.
    pub(super) apart: Vector3<L>,
    /// Corners of the triangle, relative to the core's first end.
    corners: [Vector3<L>; 3],
    /// Vector from the core's first end to its last.
    axis: Vector3<L>,
    /// Position of the core's nearest point on `axis`, 0 to 1.
    along: L,
}

impl<L: Lanes, const N: usize, const P: usize> Path<L, N, P> {
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn separation(&self, time: L) -> Separation<L> {
        let (a, b, c) = (
            self.corner(0, time),
            self.corner(1, time),
            self.corner(2, time),
        );
        let first = between(self.core_start[0], self.core_end[0], time);
        let last = between(self.core_start[N - 1], self.core_end[N - 1], time);
        let corners = [a - first, b - first, c - first];
        let axis = last - first;
        if N == 1 {
            let nearest = nearest_to_origin(corners);
            let zero = time.splat(0.0);
            let origin = Vector3 {
                x: zero,
                y: zero,
                z: zero,
            };
            return Separation {
                weights: nearest.weights,
                apart: origin - weighted(corners, nearest.weights),
                corners,
                axis,
                along: zero,
            };
        }
        let from_last = [a - last, b - last, c - last];
        let nearest = nearest_to_segment(corners, from_last, axis);
        let met = weighted(corners, nearest.weights);
        let along = nearest_on_axis(axis, met);
        Separation {
            weights: nearest.weights,
            apart: point_of_axis(axis, along) - met,
            corners,
            axis,
            along,
        }
    }
}

impl<L: Lanes, const N: usize, const P: usize> Path<L, N, P> {
    /// The position of a corner at a time.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn corner(&self, corner: usize, time: L) -> Vector3<L> {
        let start = self.corners[0][corner];
        if P == 1 {
            // As `between` computes a point that does not move: -0 becomes 0.
            let zero = time.splat(0.0);
            return Vector3 {
                x: start.x + zero,
                y: start.y + zero,
                z: start.z + zero,
            };
        }
        between(start, self.corners[P - 1][corner], time)
    }
}

impl<L: Lanes> Separation<L> {
    /// Size of the numbers that the nearest points are computed from.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn size(&self) -> L {
        let ([x, y, z], [a, b, c]) = (self.weights, self.corners);
        let on_axis = taxicab(self.axis) * self.along;
        x * taxicab(a) + y * taxicab(b) + z * taxicab(c) + on_axis
    }

    /// The vector between the nearest points, made perpendicular to the edges and the axis that these points lie
    /// within, and to those to which it is nearly perpendicular.
    ///
    /// An edge or axis may be far longer than the distance. Its nearest point is then off by the rounding of that
    /// length, and the direction by that error over the distance, so an end far away seems to lie on the wrong side. A
    /// vector that is perpendicular to the edge has no such error. The projection runs twice, since the first one
    /// leaves the rounding error of the part that it removes.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn upright(&self) -> Vector3<L> {
        let [a, b, c] = self.corners;
        let zero = self.along.splat(0.0);
        let [on_a, on_b, on_c] = self.weights.map(|weight| zero.less(weight));
        let within_axis = zero.less(self.along) & self.along.less(zero.splat(1.0));
        let ab = self.where_upright(b - a, on_a & on_b);
        let bc = without(self.where_upright(c - b, on_b & on_c), ab);
        let ca = self.where_upright(a - c, on_c & on_a);
        let ca = without(without(ca, ab), bc);
        let axis = self.where_upright(self.axis, within_axis);
        let axis = without(without(without(axis, ab), bc), ca);
        let mut upright = self.apart;
        for _ in 0..2 {
            upright = without(without(without(without(upright, ab), bc), ca), axis);
        }
        upright
    }

    /// `direction`, if the nearest point lies within it, or if it is nearly perpendicular to the vector between the
    /// nearest points; else zero.
    #[cfg_attr(not(unoptimized), inline(always))]
    fn where_upright(&self, direction: Vector3<L>, within: L::Mask) -> Vector3<L> {
        let zero = self.along.splat(0.0);
        let along = direction.dot(self.apart);
        let lengths = direction.length_squared() * self.apart.length_squared();
        let upright = (along * along).at_most(lengths * zero.splat(ALL_BUT_UPRIGHT));
        Vector3::select(within | upright, direction, direction * zero)
    }
}

/// Largest squared sine of the deviation from a right angle that counts as perpendicular: a direction may be turned by
/// that angle.
const ALL_BUT_UPRIGHT: f64 = 1.0 / (1u64 << 40) as f64;

/// `v` without its component along `direction`; zero if hardly more than rounding error is left.
#[cfg_attr(not(unoptimized), inline(always))]
fn without<L: Lanes>(v: Vector3<L>, direction: Vector3<L>) -> Vector3<L> {
    let zero = v.x.splat(0.0);
    let length_sq = direction.length_squared();
    let share = v.dot(direction) / length_sq;
    let left = v - direction * L::select(zero.less(length_sq), share, zero);
    let rounding = v.length_squared() * zero.splat(f64::EPSILON * f64::EPSILON * 1024.0);
    Vector3::select(rounding.less(left.length_squared()), left, v * zero)
}

/// The direction of `apart`, with a length of at most 1 despite rounding; zero if the distance is zero.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn direction<L: Lanes>(apart: Vector3<L>, distance: L) -> Vector3<L> {
    let zero = distance.splat(0.0);
    let shrink = zero.splat(ROUNDED_DOWN) / distance;
    Vector3::select(zero.less(distance), apart * shrink, apart * zero)
}

/// Linear interpolation from `start` at time 0 to `end` at time 1; exact at time 0.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn between<L: Lanes>(start: Vector3<L>, end: Vector3<L>, time: L) -> Vector3<L> {
    start + (end - start) * time
}
