use dashu::rational::Relaxed;
use glam::Vec3;

use super::error::RowError;
use crate::exact::{Exact, ExactPair, exact, minus, rounded};
use crate::{Core, MovingPair};

/// What a query is between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueryKind {
    /// A moving point and a moving triangle.
    VertexFace,
    /// Two moving segments.
    EdgeEdge,
}

/// A query in rational numbers, and its answer.
#[derive(Clone, Debug)]
pub struct FileQuery {
    kind: QueryKind,
    /// At both times: the vertex and the face, or the ends of one edge and of the other. Relative to the
    /// first point at time 0.
    points: [[Exact; 4]; 2],
    touches: bool,
    line: usize,
    extent: f64,
}

/// Extents that f32 holds with room for the squares that queries take.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// Radius and tolerance, as a share of a query's extent.
const REACH: f64 = 1e-5;

/// By how much the distance may change where the points are rounded, as a share of the extent: no
/// coordinate is larger than the extent, so each point is off by sqrt(3) 2^-24 at most, on both sides.
const ROUNDED: f64 = 2.2e-7;

impl FileQuery {
    /// Of points in the files' order.
    pub(super) fn new(
        kind: QueryKind,
        points: [Exact; 8],
        touches: bool,
        line: usize,
    ) -> Result<Self, RowError> {
        let [a, b, c, d, e, f, g, h] = points.each_ref().map(|p| minus(p, &points[0]));
        let points = [[a, b, c, d], [e, f, g, h]];
        let extent = extent(points.as_flattened());
        if extent != 0.0 && !EXTENTS.contains(&extent) {
            return Err(RowError::Extent { extent });
        }
        Ok(Self {
            kind,
            points,
            touches,
            line,
            extent,
        })
    }

    /// Whether the two touch at any time, by the file.
    pub fn touches(&self) -> bool {
        self.touches
    }

    /// Of its first row, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Within which a sweep is to find the other: a hundred-thousandth of the extent, which is
    /// the largest side of the box of all points.
    pub fn radius(&self) -> f32 {
        (self.extent * REACH) as f32
    }

    /// What radius and tolerance may not exceed together, for the points as they are.
    pub fn reach(&self) -> f64 {
        f64::from(self.radius()) + self.extent * REACH
    }

    /// The tolerance for the points as rounded: less, by as much as that may bring them nearer.
    pub fn tolerance(&self) -> f32 {
        let tolerance = (self.extent * (REACH - ROUNDED)) as f32;
        tolerance.next_down().max(0.0)
    }

    /// The points as they are: face and vertex, or an edge as a collapsed face and the other.
    pub fn exact(&self) -> ExactPair {
        // By number among the points at one time.
        let (corners, ends) = match self.kind {
            QueryKind::VertexFace => ([1, 2, 3], [0, 0]),
            QueryKind::EdgeEdge => ([2, 3, 3], [0, 1]),
        };
        let points = self.points.each_ref();
        ExactPair {
            corners: points.map(|points| corners.map(|k: usize| points[k].clone())),
            ends: points.map(|points| ends.map(|k: usize| points[k].clone())),
        }
    }

    /// The points rounded to f32, to be asked.
    pub fn rounded(&self) -> MovingPair {
        let ExactPair { corners, ends } = self.exact();
        let round = |p: &Exact| rounded(p).as_vec3();
        let [starts, lasts] = &ends;
        let starts_rounded = starts.each_ref().map(round);
        // From the rounded start, so that the end is off by one rounding as well.
        let motion = |k: usize| round(&minus(&lasts[k], &exact(starts_rounded[k])));
        let motions: [Vec3; 2] = [motion(0), motion(1)];
        MovingPair {
            corners: corners.each_ref().map(|c| c.each_ref().map(round)),
            core: match self.kind {
                QueryKind::VertexFace => Core::Sphere {
                    center: starts_rounded[0],
                    motion: motions[0],
                },
                QueryKind::EdgeEdge => Core::Capsule {
                    ends: starts_rounded,
                    motions,
                },
            },
            radius: self.radius(),
        }
    }
}

fn extent(points: &[Exact]) -> f64 {
    let side = |axis: usize| {
        let coordinates = || points.iter().map(|p| &p[axis]);
        let (low, high) = (coordinates().min(), coordinates().max());
        low.zip(high)
            .map_or(Relaxed::ZERO, |(low, high)| high - low)
    };
    let largest = side(0).max(side(1)).max(side(2));
    largest.to_f64().value()
}
