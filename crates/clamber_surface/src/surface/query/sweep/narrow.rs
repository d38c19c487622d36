//! Which triangles of a cluster in motion are worth an exact test, and how soon one is touched.
//!
//! As for [clusters at rest](super::super::narrow), with a code for every vertex from both ends of its
//! path.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, dispatch};

use super::super::narrow::{Codes, Survivors, each_code, survivors, vectors};
use super::super::planes::SLACK;
use super::planes::MovingPlanes;
use crate::mesh::clusters::{CornerBlock, ROW};
use crate::simd::SimdLevel;
use crate::skin::ClusterPositions;

/// Triangles that no plane rules out up to the time `until`.
pub(super) fn within_moving_planes(
    level: SimdLevel,
    positions: [&ClusterPositions; 2],
    rows: usize,
    corners: &[CornerBlock],
    (planes, until): (&MovingPlanes, f32),
) -> Survivors {
    dispatch!(level.level(), simd => {
        let codes = plane_codes(simd, positions, rows, planes, until);
        survivors(simd, corners, &codes)
    })
}

/// Triangles whose own boxes over the motion meet the box between two corners: exactly, since a code
/// has a bit for each side of the box that a vertex is beyond all the time.
pub(super) fn in_box(
    level: SimdLevel,
    positions: [&ClusterPositions; 2],
    rows: usize,
    corners: &[CornerBlock],
    sides: [[f32; 3]; 2],
) -> Survivors {
    dispatch!(level.level(), simd => {
        let codes = box_codes(simd, positions, rows, sides);
        survivors(simd, corners, &codes)
    })
}

#[inline(always)]
fn box_codes<S: Simd>(
    simd: S,
    [start, end]: [&ClusterPositions; 2],
    rows: usize,
    [low, high]: [[f32; 3]; 2],
) -> Codes {
    let low = low.map(|x| S::f32s::splat(simd, x));
    let high = high.map(|x| S::f32s::splat(simd, x));
    each_code(
        simd,
        rows,
        #[inline(always)]
        |slot| {
            let (p, q) = (
                vectors::<S>(simd, start, slot),
                vectors::<S>(simd, end, slot),
            );
            [
                p[0].simd_lt(low[0]) & q[0].simd_lt(low[0]),
                p[1].simd_lt(low[1]) & q[1].simd_lt(low[1]),
                p[2].simd_lt(low[2]) & q[2].simd_lt(low[2]),
                p[0].simd_gt(high[0]) & q[0].simd_gt(high[0]),
                p[1].simd_gt(high[1]) & q[1].simd_gt(high[1]),
                p[2].simd_gt(high[2]) & q[2].simd_gt(high[2]),
            ]
        },
    )
}

#[inline(always)]
fn plane_codes<S: Simd>(
    simd: S,
    [start, end]: [&ClusterPositions; 2],
    rows: usize,
    planes: &MovingPlanes,
    until: f32,
) -> Codes {
    let origin = planes.origin.map(|x| S::f32s::splat(simd, x));
    let slack = S::f32s::splat(simd, SLACK);
    let until = S::f32s::splat(simd, until);
    each_code(
        simd,
        rows,
        #[inline(always)]
        |slot| {
            let (p, q) = (
                vectors::<S>(simd, start, slot),
                vectors::<S>(simd, end, slot),
            );
            let p = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
            let q = [q[0] - origin[0], q[1] - origin[1], q[2] - origin[2]];
            let lost = slack * (taxicab::<S>(p) + taxicab::<S>(q));
            let q = [
                p[0] + (q[0] - p[0]) * until,
                p[1] + (q[1] - p[1]) * until,
                p[2] + (q[2] - p[2]) * until,
            ];
            [
                beyond(simd, planes, 0, [p, q], lost),
                beyond(simd, planes, 1, [p, q], lost),
                beyond(simd, planes, 2, [p, q], lost),
                beyond(simd, planes, 3, [p, q], lost),
                beyond(simd, planes, 4, [p, q], lost),
                beyond(simd, planes, 5, [p, q], lost),
                beyond(simd, planes, 6, [p, q], lost),
                beyond(simd, planes, 7, [p, q], lost),
            ]
        },
    )
}

/// Which of some points, relative to the planes' origin, lie beyond a plane at both times for all that
/// is lost.
#[inline(always)]
fn beyond<S: Simd>(
    simd: S,
    planes: &MovingPlanes,
    plane: usize,
    [p, q]: [[S::f32s; 3]; 2],
    lost: S::f32s,
) -> S::mask32s {
    let [nx, ny, nz] = &planes.normals;
    let (nx, ny, nz) = (
        S::f32s::splat(simd, nx[plane]),
        S::f32s::splat(simd, ny[plane]),
        S::f32s::splat(simd, nz[plane]),
    );
    let [first, last] = &planes.limits;
    let first = S::f32s::splat(simd, first[plane]) + lost;
    let last = S::f32s::splat(simd, last[plane]) + lost;
    let starts = (nx * p[0] + ny * p[1] + nz * p[2]).simd_gt(first);
    starts & (nx * q[0] + ny * q[1] + nz * q[2]).simd_gt(last)
}

#[inline(always)]
fn taxicab<S: Simd>([x, y, z]: [S::f32s; 3]) -> S::f32s {
    x.abs() + y.abs() + z.abs()
}

/// A ball that moves: its centre, its way, and its radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBall {
    pub(super) center: [f32; 3],
    pub(super) motion: [f32; 3],
    pub(super) radius: f32,
    /// How far its centre may be from where it should be.
    pub(super) lost: f32,
}

/// A time by which a ball has touched one of a cluster's vertices, or infinity: about the earliest.
///
/// The root of a quadratic, which rounding may put anywhere, for a ball that is a little smaller; it
/// counts if the vertex is within the ball then, for all that arithmetic may have lost.
pub(super) fn touched_by(
    level: SimdLevel,
    positions: [&ClusterPositions; 2],
    rows: usize,
    ball: &MovingBall,
) -> f32 {
    dispatch!(level.level(), simd => earliest(simd, positions, rows, ball))
}

/// How much smaller the ball is for which roots are sought: less, and rounding voids more of them;
/// more, and they come later.
const SMALLER: f32 = 1.0 / 1024.0;

/// 2^-50: of smaller lengths squares underflow.
const LEAST_RADIUS: f32 = 1.0 / (1u64 << 50) as f32;

/// Of larger lengths fourth powers overflow.
const LARGEST_SIZE: f32 = 1e9;

#[inline(always)]
fn earliest<S: Simd>(
    simd: S,
    [start, end]: [&ClusterPositions; 2],
    rows: usize,
    ball: &MovingBall,
) -> f32 {
    let number = |x: f32| S::f32s::splat(simd, x);
    let (zero, one, never) = (number(0.0), number(1.0), number(f32::INFINITY));
    let slack = number(SLACK);
    let mut least = never;
    for slot in (0..rows * ROW).step_by(S::f32s::LEN) {
        let (p, q) = (
            vectors::<S>(simd, start, slot),
            vectors::<S>(simd, end, slot),
        );
        let (mut from, mut way) = (p, p);
        for axis in 0..3 {
            from[axis] = p[axis] - number(ball.center[axis]);
            way[axis] = (q[axis] - p[axis]) - number(ball.motion[axis]);
        }
        let size = taxicab::<S>(from) + taxicab::<S>(way);
        let lost = slack * size + number(ball.lost);
        let reach = number(ball.radius * (1.0 - SMALLER)) - lost;
        let length = dot::<S>(way, way);
        let along = zero - dot::<S>(from, way);
        let depth = along * along - length * (dot::<S>(from, from) - reach * reach);
        let root = (along - depth.simd_gt(zero).select(depth, zero).sqrt()) / length;
        let time = root.simd_gt(zero).select(root, zero);
        let (x, y, z) = (
            from[0] + way[0] * time,
            from[1] + way[1] * time,
            from[2] + way[2] * time,
        );
        let within = number(ball.radius) - lost;
        let touched = (x * x + y * y + z * z).simd_le(within * within)
            & number(LEAST_RADIUS).simd_lt(reach)
            & size.simd_lt(number(LARGEST_SIZE))
            & time.simd_le(one);
        let time = touched.select(time, never);
        least = time.simd_lt(least).select(time, least);
    }
    let mut earliest = f32::INFINITY;
    for time in least.as_slice() {
        earliest = if *time < earliest { *time } else { earliest };
    }
    earliest
}

#[inline(always)]
fn dot<S: Simd>(p: [S::f32s; 3], q: [S::f32s; 3]) -> S::f32s {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
