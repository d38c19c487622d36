//! A part of the tick, for casts that take less than a whole one.

use glam::Vec3;

use crate::bounds::Spheres;
use crate::mesh::clusters::ROW;
use crate::mesh::hierarchy::LANES;
use crate::skin::ClusterPositions;

/// A part of the tick, from one share of it to another, 0..=1 and in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    from: f32,
    to: f32,
}

/// Allowance for rounding in a sphere between two others, as a share of the coordinates. The positions of a vertex and
/// of the centre are each off by at most three halves of [`f32::EPSILON`] of both ends, along each of three axes.
const SLACK: f32 = 16.0 * f32::EPSILON;

impl Span {
    /// The whole tick.
    pub(super) const WHOLE: Self = Self { from: 0.0, to: 1.0 };

    /// `None` unless both shares are from 0 to 1 and in order.
    pub(super) fn new([from, to]: [f64; 2]) -> Option<Self> {
        let is_span = 0.0 <= from && from <= to && to <= 1.0;
        is_span.then_some(Self {
            from: from as f32,
            to: to as f32,
        })
    }

    pub(super) fn is_whole(&self) -> bool {
        *self == Self::WHOLE
    }

    /// The corners, at both ends of the span, of a triangle that moves from the first corners to the last over the
    /// tick.
    pub(super) fn corners(&self, [first, last]: [[Vec3; 3]; 2]) -> [[Vec3; 3]; 2] {
        [self.from, self.to].map(|share| {
            let mut corners = first;
            for (corner, last) in corners.iter_mut().zip(last) {
                *corner = Vec3::new(
                    between(corner.x, last.x, share),
                    between(corner.y, last.y, share),
                    between(corner.z, last.z, share),
                );
            }
            corners
        })
    }

    /// Replaces positions at both ends of the tick by those at both ends of the span, in the first `rows` rows of
    /// slots.
    pub(super) fn positions(&self, [first, last]: [&mut ClusterPositions; 2], rows: usize) {
        for (first, last) in first.0.iter_mut().zip(&mut last.0) {
            for (first, last) in first.iter_mut().zip(last.iter_mut()).take(rows * ROW) {
                let (p, q) = (*first, *last);
                (*first, *last) = (between(p, q, self.from), between(p, q, self.to));
            }
        }
    }

    /// Replaces spheres at both ends of the tick by those at both ends of the span. At any share of the motion, the
    /// contents of a sphere lie in the sphere interpolated at that share.
    pub(super) fn spheres(&self, [first, last]: [&mut Spheres; 2]) {
        for lane in 0..LANES {
            let size =
                |s: &Spheres| s.x[lane].abs() + s.y[lane].abs() + s.z[lane].abs() + s.radius[lane];
            let lost = SLACK * (size(first) + size(last));
            for (first, last) in first.rows_mut().into_iter().zip(last.rows_mut()) {
                let (p, q) = (first[lane], last[lane]);
                (first[lane], last[lane]) = (between(p, q, self.from), between(p, q, self.to));
            }
            first.radius[lane] += lost;
            last.radius[lane] += lost;
        }
    }
}

/// A number at a share of the way between two: never beyond them, and exact at both ends.
fn between(p: f32, q: f32, share: f32) -> f32 {
    let (low, high) = if p < q { (p, q) } else { (q, p) };
    let x = p + (q - p) * share;
    let x = if x < low { low } else { x };
    let x = if x > high { high } else { x };
    if share == 1.0 { q } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_meets_the_next_and_stays_between() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut number = || (2.0 * rng.f32() - 1.0) * 1000.0;
        for _ in 0..1000 {
            let (p, q, share) = (number(), number(), number().abs() / 1000.0);
            assert_eq!(between(p, q, 0.0), p);
            assert_eq!(between(p, q, 1.0), q);
            let x = between(p, q, share);
            assert!(p.min(q) <= x && x <= p.max(q), "{p} {x} {q}");
            let exact = f64::from(p) + (f64::from(q) - f64::from(p)) * f64::from(share);
            let lost = f64::from(f32::EPSILON * 1.5 * (p.abs() + q.abs()));
            assert!((f64::from(x) - exact).abs() <= lost, "{p} {x} {q}");
        }
        for wrong in [
            [0.5, 0.25],
            [-0.1, 0.5],
            [0.5, 1.1],
            [f64::NAN, 1.0],
            [0.0, f64::NAN],
        ] {
            assert_eq!(Span::new(wrong), None, "{wrong:?}");
        }
    }
}
