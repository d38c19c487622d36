//! Proofs that a triangle and a core stay apart during an interval of time.
//!
//! For any vector n, the gap is `min n.(p(t) - a(t))` over the core's ends p and the corners a. The gap is a minimum of
//! linear functions of time, hence concave, and it is at most |n| times the distance. So if the gap is above
//! `radius |n|` at two times, the distance is above the radius at all times between them. If no n proves this for an
//! interval, a vector n(t) is tried that changes linearly from the interval's first time to its last. Each
//! `n(t).(p(t) - a(t))` is then quadratic in time, and nowhere less than the least of its Bernstein coefficients. If
//! that fails too, the interval is halved.
//!
//! The gap is first bounded in f64, with all rounding errors counted against the proof. Where f64 cannot decide, the
//! gap is computed in rational numbers. So the choice of n does not affect whether a proof is right, only how soon it
//! is found.

use std::cell::LazyCell;

use dashu_ratio::Relaxed;
use glam::DVec3;

use super::arithmetic::{Exact, dot, length_sq, minus, number, rounded};
use super::nearest::{Nearest, nearest};
use super::pair::ExactPair;
use crate::MovingPair;

/// Largest number of intervals in a proof; beyond it, the result is [`Apart::Unknown`]. Pairs that can be proved take
/// far fewer.
const STRETCHES: usize = 20_000;

/// Bound on the relative error of one line's gap at a time. The difference of points, its products, their sums and
/// their means take ten roundings of 2^-53; the bound is more than twice that. A value below the true error makes
/// proofs wrong.
const LOST: f64 = 24.0 / (1u64 << 53) as f64;

/// In intervals shorter than this share of the motion, directions are computed in rational numbers if the directions in
/// f64 fail. Rational numbers are slow, and wider intervals are halved instead.
const SHORT: f64 = 1e-9;

/// Bound on the loss of a gap by underflow of its products, in the unit of the points.
const UNDERFLOW: f64 = 1e-300;

/// The proved result about an interval of time: whether the distance between a triangle and a core stays greater than
/// the radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Apart {
    /// The distance is greater than the radius at all times.
    Always,
    /// The distance is at most the radius at this time.
    Until(f64),
    /// Neither could be proved near this time.
    Unknown(f64),
}

/// Whether an interval of time includes its last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Last {
    /// The interval includes its last time.
    Included,
    /// The interval excludes its last time: the distance may equal the radius then.
    Excluded,
}

/// A moving triangle and core, in f64 and, where needed, in rational numbers.
pub struct Motion<'a> {
    /// The vectors from the corners to the ends, at both times; each coordinate is rounded once.
    lines: [[[DVec3; 3]; 2]; 2],
    exact: LazyCell<ExactPair, Box<dyn FnOnce() -> ExactPair + 'a>>,
}

impl Motion<'static> {
    /// The motion of a pair in rational numbers.
    pub fn of_exact(pair: ExactPair) -> Self {
        Self {
            lines: rounded_lines(&pair),
            exact: LazyCell::new(Box::new(|| pair)),
        }
    }
}

impl<'a> Motion<'a> {
    /// The motion of a pair in f32.
    ///
    /// # Panics
    /// If a coordinate is not finite.
    pub fn new(pair: &'a MovingPair) -> Self {
        Self {
            lines: lines(pair).unwrap_or_else(|| rounded_lines(&pair.into())),
            exact: LazyCell::new(Box::new(|| pair.into())),
        }
    }

    /// The pair in rational numbers.
    pub fn exact(&self) -> &ExactPair {
        &self.exact
    }

    /// Proves or refutes that the distance is greater than the radius from time 0 to `until`.
    ///
    /// # Panics
    /// If the radius is not finite, or `until` is not in 0..=1.
    pub fn apart(&self, radius: f64, until: f64, last: Last) -> Apart {
        assert!((0.0..=1.0).contains(&until), "{until} is not in 0..=1");
        let exact_radius = number(radius);
        let size = self.size();
        let is_met = |time: f64| {
            // The approximate distance rules out most times: its error is far smaller than this margin.
            let about = self.nearest(time).distance;
            about <= radius * (1.0 + 1e-6) + size * 1e-9
                && self.exact.is_within(time, &exact_radius)
        };
        let ends = match last {
            Last::Included => &[0.0, until][..],
            Last::Excluded if until > 0.0 => &[0.0],
            Last::Excluded => &[],
        };
        if let Some(time) = ends.iter().find(|time| is_met(**time)) {
            return Apart::Until(*time);
        }
        let mut open = Vec::new();
        if until > 0.0 {
            open.push([0.0, until]);
        }
        for _ in 0..STRETCHES {
            let Some([from, to]) = open.pop() else {
                return Apart::Always;
            };
            let middle = from + (to - from) * 0.5;
            if self.is_certified(radius, [from, middle, to]) {
                continue;
            }
            if middle <= from || middle >= to {
                return Apart::Unknown(from);
            }
            if is_met(middle) {
                return Apart::Until(middle);
            }
            open.extend([[middle, to], [from, middle]]);
        }
        open.last()
            .map_or(Apart::Always, |[from, _]| Apart::Unknown(*from))
    }

    /// True if a direction proves the interval, given by its first, middle and last time. At the last time
    /// the gap may equal the radius.
    fn is_certified(&self, radius: f64, [from, middle, to]: [f64; 3]) -> bool {
        let mut open = Vec::new();
        let directions = [to, from, middle].map(|time| self.nearest(time).direction);
        for n in directions {
            match self.separates(n, radius, [from, to]) {
                Some(true) => return true,
                Some(false) => {}
                None => open.push(n),
            }
        }
        if self.separates_turning([directions[1], directions[0]], radius, [from, to]) {
            return true;
        }
        let is_shown = |n: &Exact| {
            n.iter().any(|x| *x != Relaxed::ZERO) && self.separates_exactly(n, radius, [from, to])
        };
        if open.iter().any(|n| is_shown(&n.to_array().map(number))) {
            return true;
        }
        // For a sliver, rounding in f64 may choose the wrong nearest edge. In rational numbers, the edge is right.
        to - from < SHORT
            && [to, from]
                .iter()
                .any(|time| is_shown(&self.exact.apart(&number(*time))))
    }

    /// Whether a direction separates the pair in an interval; `None` if rounding leaves it open.
    fn separates(&self, n: DVec3, radius: f64, times: [f64; 2]) -> Option<bool> {
        if n == DVec3::ZERO {
            return Some(false);
        }
        let limit = radius * n.length();
        let mut all = true;
        for [start, end] in self.each_line() {
            let (h0, h1) = (n.dot(start), n.dot(end));
            let (size0, size1) = (n.abs().dot(start.abs()), n.abs().dot(end.abs()));
            for time in times {
                let gap = h0 * (1.0 - time) + h1 * time;
                let size = size0 * (1.0 - time) + size1 * time;
                let lost = LOST * (size + limit) + UNDERFLOW;
                if gap + lost < limit {
                    return Some(false);
                }
                all &= gap - lost > limit;
            }
        }
        all.then_some(true)
    }

    /// True if a direction that changes linearly from `n` to `m` separates the pair in an interval; false if
    /// rounding leaves it open.
    fn separates_turning(&self, [n, m]: [DVec3; 2], radius: f64, [from, to]: [f64; 2]) -> bool {
        if n == DVec3::ZERO || m == DVec3::ZERO {
            return false;
        }
        let limit = radius * n.length().max(m.length());
        let along = |n: DVec3, [start, end]: [DVec3; 2], time: f64| {
            let mean = |h0: f64, h1: f64| h0 * (1.0 - time) + h1 * time;
            let gap = mean(n.dot(start), n.dot(end));
            let size = mean(n.abs().dot(start.abs()), n.abs().dot(end.abs()));
            [gap, size]
        };
        self.each_line().all(|line| {
            let first = along(n, line, from);
            let last = along(m, line, to);
            let [a, b] = [along(n, line, to), along(m, line, from)];
            let between = [0, 1].map(|k| (a[k] + b[k]) * 0.5);
            [first, between, last]
                .iter()
                .all(|[gap, size]| gap - (LOST * (size + limit) + UNDERFLOW) > limit)
        })
    }

    fn separates_exactly(&self, n: &Exact, radius: f64, [from, to]: [f64; 2]) -> bool {
        let radius = number(radius);
        let limit_sq = &radius * &radius * length_sq(n);
        let pair = &*self.exact;
        let times = [number(from), number(to)];
        let [[a0, b0], [a1, b1]] = &pair.ends;
        [[a0, a1], [b0, b1]].into_iter().all(|[end, end_later]| {
            (0..3).all(|corner| {
                let [first, last] = &pair.corners;
                let h0 = dot(n, &minus(end, &first[corner]));
                let h1 = dot(n, &minus(end_later, &last[corner]));
                let gaps = times.each_ref().map(|time| &h0 + (&h1 - &h0) * time);
                // Above the limit at the first time and not below it at the last: above at all times between.
                let squares = gaps.each_ref().map(|gap| gap * gap);
                gaps[0] > Relaxed::ZERO
                    && squares[0] > limit_sq
                    && gaps[1] >= Relaxed::ZERO
                    && squares[1] >= limit_sq
            })
        })
    }

    fn each_line(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let of = |end: &[[DVec3; 3]; 2]| [0, 1, 2].map(|k| [end[0][k], end[1][k]]);
        self.lines.each_ref().map(of).into_iter().flatten()
    }

    fn nearest(&self, time: f64) -> Nearest {
        let at = |end: &[[DVec3; 3]; 2], k: usize| end[0][k] * (1.0 - time) + end[1][k] * time;
        let [first, second] = &self.lines;
        // All points are relative to the first end.
        let corners = [0, 1, 2].map(|k| -at(first, k));
        let axis = at(second, 0) - at(first, 0);
        nearest(corners, [DVec3::ZERO, axis])
    }

    fn size(&self) -> f64 {
        let lines = self.each_line().flatten();
        lines.map(DVec3::length).fold(0.0, f64::max)
    }
}

/// The vectors from the corners to the ends, each coordinate rounded once; `None` if an end at time 1 is not
/// exact in f64.
fn lines(pair: &MovingPair) -> Option<[[[DVec3; 3]; 2]; 2]> {
    let [ends, motions] = [pair.ends, pair.motions].map(|points| points.map(|p| p.as_dvec3()));
    let [first, last] = pair.corners.map(|corners| corners.map(|p| p.as_dvec3()));
    let mut lines = [[[DVec3::ZERO; 3]; 2]; 2];
    for ((line, end), motion) in lines.iter_mut().zip(ends).zip(motions) {
        let later = end + motion;
        if later - end != motion || later - motion != end {
            return None;
        }
        *line = [first.map(|p| end - p), last.map(|p| later - p)];
    }
    Some(lines)
}

fn rounded_lines(pair: &ExactPair) -> [[[DVec3; 3]; 2]; 2] {
    [0, 1].map(|end| {
        [0, 1].map(|time| {
            let corners = pair.corners[time].each_ref();
            corners.map(|corner| rounded(&minus(&pair.ends[time][end], corner)))
        })
    })
}

#[cfg(test)]
mod tests;
