use super::path::Path;
use super::{LOST, NEVER, ROUNDED_DOWN, ROUNDED_UP};
use crate::geometry::lanes::Lanes;
use crate::geometry::vector3::Vector3;

/// When the gap along a direction is large enough.
pub(super) struct Gaps<L: Lanes> {
    /// From here, ...
    pub(super) from: L,
    /// ... until here, which may be [`NEVER`] for both.
    pub(super) until: L,
    /// The line that is lowest at the time asked for falls.
    pub(super) approaching: L::Mask,
}

/// What has to be left of the ends of each line: the radius, and what arithmetic may have taken, of the
/// core's part and of the triangle's.
#[derive(Clone, Copy)]
pub(super) struct Floors<L, const N: usize> {
    core_start: [L; N],
    core_end: [L; N],
    start: [L; 3],
    end: [L; 3],
}

impl<L: Lanes, const N: usize> Path<L, N> {
    #[inline(always)]
    pub(super) fn floors(&self) -> Floors<L, N> {
        let zero = self.radius.splat(0.0);
        let (mut core_start, mut core_end) = ([zero; N], [zero; N]);
        let (mut start, mut end) = ([zero; 3], [zero; 3]);
        let lost = zero.splat(LOST);
        for k in 0..N {
            core_start[k] = self.radius + (taxicab(self.core_start[k]) + self.radius) * lost;
            core_end[k] = self.radius + (taxicab(self.core_end[k]) + self.radius) * lost;
        }
        for k in 0..3 {
            start[k] = taxicab(self.start[k]) * lost;
            end[k] = taxicab(self.end[k]) * lost;
        }
        Floors {
            core_start,
            core_end,
            start,
            end,
        }
    }

    /// When the gap along `n` is large enough, and whether it falls at `time`.
    #[inline(always)]
    pub(super) fn gaps(&self, n: Vector3<L>, floors: &Floors<L, N>, time: L) -> Gaps<L> {
        let zero = time.splat(0.0);
        let never = zero.splat(NEVER);
        let (mut from, mut until) = (zero, never);
        let (mut least, mut slope) = (zero.splat(f64::INFINITY), zero);
        for end in 0..N {
            let core_start = n.dot(self.core_start[end]) - floors.core_start[end];
            let core_end = n.dot(self.core_end[end]) - floors.core_end[end];
            for corner in 0..3 {
                let h0 = core_start - (n.dot(self.start[corner]) + floors.start[corner]);
                let h1 = core_end - (n.dot(self.end[corner]) + floors.end[corner]);
                // Where the line `h0 (1 - t) + h1 t` passes through 0, if it does.
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
}

/// The sum of absolute coordinates.
#[inline(always)]
pub(super) fn taxicab<L: Lanes>(v: Vector3<L>) -> L {
    let absolute = |x: L| x.or_larger(-x);
    absolute(v.x) + absolute(v.y) + absolute(v.z)
}
