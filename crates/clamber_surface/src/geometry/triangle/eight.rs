//! Eight triangles at a time: the source of the scalar tests on SIMD registers, with the same bits.

use fearless_simd::{Simd, SimdBase, dispatch};
use glam::{DVec3, Vec3};

use super::TrianglePoint;
use super::candidate::Candidate;
use super::point::nearest_to_origin;
use super::segment::{nearest_to_segment, ordered};
use crate::geometry::lanes::Wide;
use crate::geometry::vector3::Vector3;
use crate::geometry::widen;
use crate::simd::SimdLevel;

/// Number of triangles per call. They fill one register of f64 at the widest SIMD level, four at the narrowest.
pub(crate) const EIGHT: usize = 8;

/// Corners of eight triangles: `x[corner][lane]`. Unused lanes may hold any finite numbers.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Corners8 {
    pub(crate) x: [[f32; EIGHT]; 3],
    pub(crate) y: [[f32; EIGHT]; 3],
    pub(crate) z: [[f32; EIGHT]; 3],
}

impl Corners8 {
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn set(&mut self, lane: usize, corners: [Vec3; 3]) {
        for (corner, position) in corners.into_iter().enumerate() {
            self.x[corner][lane] = position.x;
            self.y[corner][lane] = position.y;
            self.z[corner][lane] = position.z;
        }
    }

    pub(crate) fn get(&self, lane: usize) -> [Vec3; 3] {
        [0, 1, 2].map(|corner| {
            let axes = [&self.x, &self.y, &self.z];
            Vec3::from(axes.map(|axis| axis[corner][lane]))
        })
    }
}

/// A [`TrianglePoint`] for each of eight triangles.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Points8 {
    /// `barycentric[corner][lane]`.
    pub(crate) barycentric: [[f64; EIGHT]; 3],
    pub(crate) distance: [f64; EIGHT],
}

impl Points8 {
    pub(crate) fn get(&self, lane: usize) -> TrianglePoint {
        let [a, b, c] = &self.barycentric;
        TrianglePoint {
            barycentric: DVec3::new(a[lane], b[lane], c[lane]),
            distance: self.distance[lane],
        }
    }
}

/// [`closest_point`](super::closest_point) of each triangle, with the same bits.
pub(crate) fn closest_points(level: SimdLevel, corners: &Corners8, p: Vec3, points: &mut Points8) {
    dispatch!(level.level(), simd => closest_points_simd(simd, corners, p, points));
}

/// [`closest_to_segment`](super::closest_to_segment) of each triangle, with the same bits.
pub(crate) fn closest_to_segments(
    level: SimdLevel,
    corners: &Corners8,
    segment: [Vec3; 2],
    points: &mut Points8,
) {
    dispatch!(level.level(), simd => closest_to_segments_simd(simd, corners, segment, points));
}

#[cfg_attr(not(unoptimized), inline(always))]
fn closest_points_simd<S: Simd>(simd: S, corners: &Corners8, p: Vec3, points: &mut Points8) {
    let corners = Corners8Wide::new(corners);
    let p = splat(simd, widen(p));
    for first in (0..EIGHT).step_by(S::f64s::LEN) {
        let found = nearest_to_origin(corners.relative_to(simd, first, p));
        store(found, first, points);
    }
}

#[cfg_attr(not(unoptimized), inline(always))]
fn closest_to_segments_simd<S: Simd>(
    simd: S,
    corners: &Corners8,
    [a, b]: [Vec3; 2],
    points: &mut Points8,
) {
    let corners = Corners8Wide::new(corners);
    let [a, b] = ordered(a, b);
    let axis = splat(simd, widen(b) - widen(a));
    let (a, b) = (splat(simd, widen(a)), splat(simd, widen(b)));
    for first in (0..EIGHT).step_by(S::f64s::LEN) {
        let from_start = corners.relative_to(simd, first, a);
        let from_end = corners.relative_to(simd, first, b);
        store(
            nearest_to_segment(from_start, from_end, axis),
            first,
            points,
        );
    }
}

/// [`Corners8`] in f64. The compiler turns plain loops over these arrays into vector conversions and keeps the arrays
/// in registers.
pub(super) struct Corners8Wide {
    x: [[f64; EIGHT]; 3],
    y: [[f64; EIGHT]; 3],
    z: [[f64; EIGHT]; 3],
}

impl Corners8Wide {
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn new(corners: &Corners8) -> Self {
        Self {
            x: widen_rows(&corners.x),
            y: widen_rows(&corners.y),
            z: widen_rows(&corners.z),
        }
    }

    /// The corners in the lanes from `first` on, minus `origin`.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn relative_to<S: Simd>(
        &self,
        simd: S,
        first: usize,
        origin: Vector3<Wide<S>>,
    ) -> [Vector3<Wide<S>>; 3] {
        [
            self.corner(simd, 0, first) - origin,
            self.corner(simd, 1, first) - origin,
            self.corner(simd, 2, first) - origin,
        ]
    }

    #[cfg_attr(not(unoptimized), inline(always))]
    fn corner<S: Simd>(&self, simd: S, corner: usize, first: usize) -> Vector3<Wide<S>> {
        let end = first + S::f64s::LEN;
        Vector3 {
            x: Wide(S::f64s::from_slice(simd, &self.x[corner][first..end])),
            y: Wide(S::f64s::from_slice(simd, &self.y[corner][first..end])),
            z: Wide(S::f64s::from_slice(simd, &self.z[corner][first..end])),
        }
    }
}

#[cfg_attr(not(unoptimized), inline(always))]
fn widen_rows(rows: &[[f32; EIGHT]; 3]) -> [[f64; EIGHT]; 3] {
    let mut wide = [[0.0; EIGHT]; 3];
    for corner in 0..3 {
        for lane in 0..EIGHT {
            wide[corner][lane] = f64::from(rows[corner][lane]);
        }
    }
    wide
}

#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn splat<S: Simd>(simd: S, v: DVec3) -> Vector3<Wide<S>> {
    Vector3 {
        x: Wide(S::f64s::splat(simd, v.x)),
        y: Wide(S::f64s::splat(simd, v.y)),
        z: Wide(S::f64s::splat(simd, v.z)),
    }
}

#[cfg_attr(not(unoptimized), inline(always))]
fn store<S: Simd>(found: Candidate<Wide<S>>, first: usize, points: &mut Points8) {
    let end = first + S::f64s::LEN;
    for corner in 0..3 {
        found.weights[corner]
            .0
            .store_slice(&mut points.barycentric[corner][first..end]);
    }
    found
        .distance
        .0
        .store_slice(&mut points.distance[first..end]);
}
