use super::path::Path;
use super::separation::between;
use super::{LOST, NEVER, ROUNDED_DOWN, ROUNDED_UP};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// The interval of time in which the gap along a direction is large enough.
pub(super) struct Gaps<L: Lanes> {
    /// Start of the interval.
    pub(super) from: L,
    /// End of the interval. Start and end may both be [`NEVER`].
    pub(super) until: L,
    /// True if the line that is lowest at the given time falls.
    pub(super) approaching: L::Mask,
}

/// Lower limits for the ends of each line: the radius and the allowance for rounding, split into the core's part and
/// the triangle's part.
#[derive(Clone, Copy)]
pub(super) struct Floors<L, const N: usize, const P: usize> {
    core_start: [L; N],
    core_end: [L; N],
    corners: [[L; 3]; P],
}

impl<L: Lanes, const N: usize, const P: usize> Path<L, N, P> {
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn floors(&self) -> Floors<L, N, P> {
        let zero = self.radius.splat(0.0);
        let (mut core_start, mut core_end) = ([zero; N], [zero; N]);
        let mut corners = [[zero; 3]; P];
        let lost = zero.splat(LOST);
        for k in 0..N {
            core_start[k] = self.radius + (taxicab(self.core_start[k]) + self.radius) * lost;
            core_end[k] = self.radius + (taxicab(self.core_end[k]) + self.radius) * lost;
        }
        for (floors, corners) in corners.iter_mut().zip(&self.corners) {
            for k in 0..3 {
                floors[k] = taxicab(corners[k]) * lost;
            }
        }
        Floors {
            core_start,
            core_end,
            corners,
        }
    }

    /// The interval in which the gap along `n` is large enough, and whether the gap falls at `time`.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn gaps(&self, n: Vector3<L>, floors: &Floors<L, N, P>, time: L) -> Gaps<L> {
        let zero = time.splat(0.0);
        let never = zero.splat(NEVER);
        let (mut from, mut until) = (zero, never);
        let (mut least, mut slope) = (zero.splat(f64::INFINITY), zero);
        for end in 0..N {
            let core_start = n.dot(self.core_start[end]) - floors.core_start[end];
            let core_end = n.dot(self.core_end[end]) - floors.core_end[end];
            for corner in 0..3 {
                let mut along = [zero; P];
                let poses = self.corners.iter().zip(&floors.corners);
                for (along, (corners, floors)) in along.iter_mut().zip(poses) {
                    *along = n.dot(corners[corner]) + floors[corner];
                }
                let h0 = core_start - along[0];
                let h1 = core_end - along[P - 1];
                // The time at which the line `h0 (1 - t) + h1 t` passes through 0, if it does.
                let root = h0 / (h0 - h1);
                let (low_first, low_last) = (h0.less(zero), h1.less(zero));
                let begin = L::select(low_last, never, root * zero.splat(ROUNDED_UP));
                from = from.or_larger(L::select(low_first, begin, zero));
                let end = L::select(low_first, zero, root * zero.splat(ROUNDED_DOWN));
                until = until.or_smaller(L::select(low_last, end, never));
                let change = h1 - h0;
                let now = h0 + change * time;
                let less = now.less(least);
                least = L::select(less, now, least);
                slope = L::select(less, change, slope);
            }
        }
        Gaps {
            from,
            until,
            approaching: slope.less(zero),
        }
    }

    /// True if the gap is large enough at all times between two, along a direction that turns linearly from the first
    /// to the second.
    ///
    /// The gap of each end and corner is then quadratic in time, and never less than the least of its coefficients in
    /// the Bernstein basis.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn holds_turning(
        &self,
        n: [Vector3<L>; 2],
        times: [L; 2],
        floors: &Floors<L, N, P>,
    ) -> L::Mask {
        let zero = self.radius.splat(0.0);
        let corners = [0, 1, 2].map(
            #[cfg_attr(not(unoptimized), inline(always))]
            |k| {
                let floor = floors.corners[0][k].or_larger(floors.corners[P - 1][k]);
                along_turning(
                    n,
                    times.map(
                        #[cfg_attr(not(unoptimized), inline(always))]
                        |time| self.corner(k, time),
                    ),
                )
                .map(
                    #[cfg_attr(not(unoptimized), inline(always))]
                    |part| part + floor,
                )
            },
        );
        let mut least = zero.splat(f64::INFINITY);
        for end in 0..N {
            let floor = floors.core_start[end].or_larger(floors.core_end[end]);
            let core = along_turning(
                n,
                times.map(
                    #[cfg_attr(not(unoptimized), inline(always))]
                    |time| between(self.core_start[end], self.core_end[end], time),
                ),
            );
            for corner in corners {
                for (core, corner) in core.into_iter().zip(corner) {
                    least = least.or_smaller(core - floor - corner);
                }
            }
        }
        zero.at_most(least)
    }
}

/// Coefficients, in the Bernstein basis, of the product of a direction and a point that both change linearly from the
/// first to the second.
#[cfg_attr(not(unoptimized), inline(always))]
fn along_turning<L: Lanes>([n, m]: [Vector3<L>; 2], [p, q]: [Vector3<L>; 2]) -> [L; 3] {
    let between = (n.dot(q) + m.dot(p)) * p.x.splat(0.5);
    [n.dot(p), between, m.dot(q)]
}

/// The sum of absolute coordinates.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn taxicab<L: Lanes>(v: Vector3<L>) -> L {
    let absolute = |x: L| x.or_larger(-x);
    absolute(v.x) + absolute(v.y) + absolute(v.z)
}
