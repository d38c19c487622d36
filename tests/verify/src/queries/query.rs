use dashu_ratio::Relaxed;

use crate::MovingPair;
use crate::exact::{Exact, ExactPair, exact, minus, rounded};

/// The two shapes of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QueryKind {
    /// A moving point and a moving triangle.
    VertexFace,
    /// Two moving segments.
    EdgeEdge,
}

/// A query of a file, in rational numbers, and its answer.
#[derive(Clone, Debug)]
pub struct FileQuery {
    kind: QueryKind,
    /// At time 0 and at time 1: the vertex and the face, or the ends of one edge and of the other. Relative
    /// to the first point at time 0.
    points: [[Exact; 4]; 2],
    /// True if the two shapes touch at some time, according to the file.
    pub touches: bool,
    /// The line of its first row in the file, from 1.
    pub line: usize,
    extent: f64,
}

/// Extents that f32 can hold with room to spare, in the units of the file. A query outside of this range is an error.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

/// The radius, and the tolerance before rounding, each as a share of a query's extent. It is far larger than
/// [`ROUNDED`], so a sweep of the rounded points must find every contact.
const REACH: f64 = 1e-5;

/// Bound on the change of the distance when the points are rounded, as a share of the extent. No coordinate
/// is larger than the extent, so each of the two nearest points is off by at most sqrt(3) 2^-24.
const ROUNDED: f64 = 2.2e-7;

impl FileQuery {
    /// A query of points in the order of the files.
    pub(super) fn new(
        kind: QueryKind,
        points: [Exact; 8],
        touches: bool,
        line: usize,
    ) -> Result<Self, String> {
        let [a, b, c, d, e, f, g, h] = points.each_ref().map(|p| minus(p, &points[0]));
        let points = [[a, b, c, d], [e, f, g, h]];
        let extent = extent(points.as_flattened());
        if extent != 0.0 && !EXTENTS.contains(&extent) {
            return Err(format!(
                "a query of extent {extent:e} does not fit f32: expected 1e-30 to 1e30, or 0"
            ));
        }
        Ok(Self {
            kind,
            points,
            touches,
            line,
            extent,
        })
    }

    /// The radius for a sweep: 1e-5 of the extent, which is the largest side of the bounding box of all points.
    pub fn radius(&self) -> f32 {
        (self.extent * REACH) as f32
    }

    /// The largest distance between the two exact shapes at which a sweep of the rounded points may report a hit, in
    /// the units of the file. It leaves room for [`FileQuery::radius`], [`FileQuery::tolerance`], and the change of the
    /// distance by rounding.
    pub fn reach(&self) -> f64 {
        f64::from(self.radius()) + self.extent * REACH
    }

    /// The tolerance for a sweep of the rounded points: [`FileQuery::reach`] less the radius, and less the largest
    /// change of the distance by rounding.
    pub fn tolerance(&self) -> f32 {
        let tolerance = (self.extent * (REACH - ROUNDED)) as f32;
        tolerance.next_down().max(0.0)
    }

    /// The exact points: the face and the vertex, or one edge as a collapsed face and the other edge.
    pub fn exact(&self) -> ExactPair {
        // Indices of the points at one time.
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

    /// The points rounded to f32, as the input of a sweep.
    pub fn rounded(&self) -> MovingPair {
        let ExactPair { corners, ends } = self.exact();
        let round = |p: &Exact| rounded(p).as_vec3();
        let [starts, lasts] = &ends;
        let starts_rounded = starts.each_ref().map(round);
        // The displacement is computed from the rounded start, so that the end, too, is off by only one rounding.
        let motion = |k: usize| round(&minus(&lasts[k], &exact(starts_rounded[k])));
        MovingPair {
            corners: corners.each_ref().map(|c| c.each_ref().map(round)),
            ends: starts_rounded,
            motions: [motion(0), motion(1)],
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
