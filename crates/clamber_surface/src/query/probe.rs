use glam::{DVec3, Vec3};

use super::span::Span;
use crate::geometry::triangle::{
    Contact, Corners8, MovingCore, Points8, TrianglePoint, closest_point, closest_points,
    closest_to_segment, closest_to_segments,
};
use crate::geometry::{Capsule, round_to_f32, round_up_to_f32, widen};
use crate::simd::SimdLevel;

/// Allowance for the error of an exact test, as a share of the lengths involved (segment, edges, distance): four times
/// the gap of 2^-48 that counts as a crossing of segment and triangle, and some thirty times the rounding error. A
/// smaller value loses triangles that the exact test accepts; a larger one tests more triangles.
pub(super) const BLUR: f64 = 1.0 / (1u64 << 46) as f64;

/// Allowance for rounding that widens a tolerance, as a share of the lengths involved: eight times the 2^-46 of
/// [`first_contact`](crate::geometry::triangle::first_contact).
const TOLERANCE_BLUR: f64 = 1.0 / (1u64 << 43) as f64;

/// The shape of a query: a ball (N = 1) or a capsule (N = 2), each of whose ends may move on a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe<const N: usize> {
    pub(super) ends: [Vec3; N],
    /// Displacements of the ends from time 0 to time 1.
    pub(super) motions: [Vec3; N],
    pub(super) radius: f32,
    /// Distance from the core within which triangles matter.
    pub(super) reach: f32,
}

/// Evaluates an expression with a [`Probe`]: of one end if the capsule is a ball and stays one, else of two.
macro_rules! with_probe {
    ($capsule:expr, $motions:expr, $probe:ident => $call:expr) => {{
        let (capsule, [of_a, of_b]): (&crate::geometry::Capsule, [glam::Vec3; 2]) =
            ($capsule, $motions);
        if capsule.is_ball() && of_a == of_b {
            let $probe = crate::query::probe::Probe::of_ball(capsule, of_a);
            $call
        } else {
            let $probe = crate::query::probe::Probe::of_capsule(capsule, [of_a, of_b]);
            $call
        }
    }};
}
pub(super) use with_probe;

impl Probe<1> {
    pub(super) fn of_ball(ball: &Capsule, motion: Vec3) -> Self {
        Self {
            ends: [ball.ends()[0]],
            motions: [motion],
            radius: ball.radius(),
            reach: ball.radius(),
        }
    }
}

impl Probe<2> {
    pub(super) fn of_capsule(capsule: &Capsule, motions: [Vec3; 2]) -> Self {
        Self {
            ends: capsule.ends(),
            motions,
            radius: capsule.radius(),
            reach: capsule.radius(),
        }
    }
}

impl<const N: usize> Probe<N> {
    /// The first and the last end, which are the same for a ball.
    pub(super) fn segment(&self) -> [Vec3; 2] {
        [self.ends[0], self.ends[N - 1]]
    }

    /// The middle of the core. The normal of a hit on a collapsed triangle points to it.
    pub(super) fn middle(&self) -> Vec3 {
        match self.segment() {
            [center, _] if N == 1 => center,
            [a, b] => a * 0.5 + b * 0.5,
        }
    }

    /// A point of the core, about the nearest to `target`, and how far rounding may have displaced it.
    pub(super) fn facing(&self, target: Vec3) -> (Vec3, f64) {
        let [a, b] = self.segment().map(widen);
        if N == 1 {
            return (self.ends[0], 0.0);
        }
        let axis = b - a;
        let along = (widen(target) - a).dot(axis) / axis.length_squared();
        // NaN gives the first end.
        let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
        let exact = a + axis * along;
        let rounded = round_to_f32(exact);
        let size = a.length() + axis.length();
        (rounded, (widen(rounded) - exact).length() + size * BLUR)
    }

    /// How far beyond the radius the exact test may still accept a triangle, on a surface that is `size` across.
    pub(super) fn blur(&self, size: f64) -> f64 {
        if N == 1 {
            // The error of a point's distance is a share of that distance: `box_around` allows for it.
            return 0.0;
        }
        let [a, b] = self.segment().map(widen);
        BLUR * ((b - a).length() + f64::from(self.radius) + size)
    }

    /// The same probe with the reach of a query for triangles within `distance` of its core.
    pub(super) fn reaching(&self, distance: f64) -> Self {
        Self {
            reach: round_up_to_f32(distance),
            ..*self
        }
    }

    /// The box around everything within `distance` of the core before it moves, rounded outwards.
    pub(super) fn box_around(&self, distance: f64) -> [[f32; 3]; 2] {
        // Covers some roundings of 2^-53 in the exact test.
        let distance = distance * (1.0 + 1e-12);
        let [a, b] = self.segment();
        let up = |x: f32| round_up_to_f32(f64::from(x) + distance);
        let low = (-a.min(b)).to_array().map(|x| -up(x));
        [low, a.max(b).to_array().map(up)]
    }

    /// The point of a triangle closest to the core.
    pub(super) fn closest(&self, corners: [Vec3; 3]) -> TrianglePoint {
        let [a, b] = self.segment();
        if N == 1 {
            closest_point(corners, a)
        } else {
            closest_to_segment(corners, a, b)
        }
    }

    /// [`Probe::closest`] for eight triangles.
    pub(super) fn closest_of_eight(
        &self,
        level: SimdLevel,
        corners: &Corners8,
        points: &mut Points8,
    ) {
        let [a, b] = self.segment();
        if N == 1 {
            closest_points(level, corners, a, points);
        } else {
            closest_to_segments(level, corners, [a, b], points);
        }
    }
}

/// A moving probe and the tolerance of its contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep<const N: usize> {
    pub(super) probe: Probe<N>,
    pub(super) core: MovingCore<N>,
    /// The part of the tick that the sweep takes.
    pub(super) span: Span,
    /// If true, triangles that the sweep overlaps at the start do not count.
    pub(super) past_overlaps: bool,
}

impl<const N: usize> Sweep<N> {
    /// A sweep for which a gap of up to `tolerance` is a contact. `None` if a motion or the tolerance is not finite, or
    /// if the tolerance is negative.
    pub(super) fn new(probe: Probe<N>, tolerance: f32, span: Span) -> Option<Self> {
        let moves = probe.motions.iter().all(|motion| motion.is_finite());
        let usable = moves && (0.0..f32::INFINITY).contains(&tolerance);
        usable.then(|| Self {
            probe,
            core: MovingCore::new(probe.ends, probe.motions, probe.radius, tolerance),
            span,
            past_overlaps: false,
        })
    }

    /// True if this is the contact of a triangle that the sweep overlaps at the start.
    pub(super) fn started_inside(&self, contact: &Contact) -> bool {
        contact.time == 0.0 && contact.distance <= self.core.radius
    }

    /// False for contacts that the sweep ignores.
    pub(super) fn counts(&self, contact: &Contact) -> bool {
        !(self.past_overlaps && self.started_inside(contact))
    }

    /// The same sweep with the reach that it has among triangles that are at most `size` across and `size` away.
    pub(super) fn among(&self, size: f64) -> Self {
        let core = &self.core;
        let reach = core.radius + core.tolerance + TOLERANCE_BLUR * (size + core.radius);
        Self {
            probe: self.probe.reaching(reach),
            ..*self
        }
    }

    /// An upper bound of the length of its core and of its path.
    pub(super) fn length(&self) -> f64 {
        let ends = self.core.start.iter().chain(&self.core.end);
        ends.map(|end| end.length()).sum()
    }

    /// The box around everything that it reaches on its path, rounded outwards.
    #[inline]
    pub(super) fn bounds(&self) -> [[f32; 3]; 2] {
        let origin = widen(self.core.origin);
        let ends = self.core.start.iter().chain(&self.core.end);
        let (low, high) = ends.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), end| (low.min(origin + *end), high.max(origin + *end)),
        );
        // One step of f32 is more than the error of the sums.
        let reach = f64::from(self.probe.reach);
        let up = |x: f64| round_up_to_f32(x + reach).next_up();
        [(-low).to_array().map(|x| -up(x)), high.to_array().map(up)]
    }
}
