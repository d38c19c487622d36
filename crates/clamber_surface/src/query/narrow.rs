//! Selects the triangles of a posed cluster that need an exact test.
//!
//! Every vertex gets a code with a bit for each half-space that it lies in. A half-space is beyond a plane that touches
//! the query's region, or beside the query's ray. A triangle whose corners share a bit lies in that half-space as well
//! and is ruled out (Cohen and Sutherland's line clipping; Foley, van Dam, Feiner, Hughes 1990, *Computer Graphics*,
//! 3.12). Codes are computed for as many vertices at once as a SIMD register holds, and looked up for 32 triangles at
//! once. A vertex that moves is beyond a plane if it is so at both ends of its path.

use fearless_simd::{Level, Select, Simd, SimdBase, SimdFloat, SimdMask, u8x32};

use super::broad::SLACK;
use super::planes::Planes;
use crate::geometry::triangle::{EIGHT, ShearedRay};
use crate::mesh::clusters::{BLOCK, CornerBlock, MAX_SLOTS, MAX_TRIANGLES, ROW};
use crate::skin::ClusterPositions;

/// The triangles of a cluster that are not ruled out, one bit each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Survivors([u32; MAX_TRIANGLES / BLOCK]);

impl Survivors {
    /// Drops all triangles from number `count` on.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn truncate(&mut self, count: usize) {
        for (block, bits) in self.0.iter_mut().enumerate() {
            let left = count.saturating_sub(block * BLOCK);
            if left < BLOCK {
                *bits &= (1 << left) - 1;
            }
        }
    }

    /// Keeps the triangles that `keeps` accepts.
    #[inline(never)]
    pub(super) fn retain(&mut self, keeps: impl Fn(usize) -> bool) {
        for triangle in (*self).iter() {
            if !keeps(triangle) {
                self.0[triangle / BLOCK] &= !(1 << (triangle % BLOCK));
            }
        }
    }

    /// The triangles that are in both.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn and(mut self, other: Self) -> Self {
        for (bits, other) in self.0.iter_mut().zip(other.0) {
            *bits &= other;
        }
        self
    }

    /// The triangles that are not in `other`.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn without(mut self, other: Self) -> Self {
        for (bits, other) in self.0.iter_mut().zip(other.0) {
            *bits &= !other;
        }
        self
    }

    /// Triangles by ascending number.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn iter(self) -> impl Iterator<Item = usize> {
        let Self(mut blocks) = self;
        let mut block = 0;
        std::iter::from_fn(
            #[cfg_attr(not(unoptimized), inline(always))]
            move || {
                while block < blocks.len() {
                    let bits = &mut blocks[block];
                    if *bits != 0 {
                        let bit = bits.trailing_zeros() as usize;
                        *bits &= *bits - 1;
                        return Some(block * BLOCK + bit);
                    }
                    block += 1;
                }
                None
            },
        )
    }

    /// Calls `test` with up to eight triangles at a time, in order.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn by_eight(self, mut test: impl FnMut(&[u8])) {
        let mut batch = [0; EIGHT];
        let mut count = 0;
        for triangle in self.iter() {
            batch[count % EIGHT] = triangle as u8;
            count += 1;
            if count == EIGHT {
                test(&batch);
                count = 0;
            }
        }
        if count > 0 {
            test(&batch[..count]);
        }
    }
}

/// One code per slot.
type Codes = [u8; MAX_SLOTS];

/// Triangles that no plane rules out up to the time `until`.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn within_planes<S: Simd, const P: usize>(
    simd: S,
    positions: [&ClusterPositions; P],
    rows: usize,
    corners: &[CornerBlock],
    planes: &Planes<P>,
    until: f32,
) -> Survivors {
    let codes = plane_codes(simd, positions, rows, planes, until);
    survivors(simd, corners, &codes)
}

/// Triangles whose bounding boxes over the motion overlap the box between two corners. This is exact, since a code has
/// a bit for each side of the box, set if the vertex is beyond that side at both ends of its path.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn in_box<S: Simd, const P: usize>(
    simd: S,
    positions: [&ClusterPositions; P],
    rows: usize,
    corners: &[CornerBlock],
    sides: [[f32; 3]; 2],
) -> Survivors {
    let codes = box_codes(simd, [positions[0], positions[P - 1]], rows, sides);
    survivors(simd, corners, &codes)
}

/// Triangles that a ray may meet up to the distance `limit`. Positions are sheared with the bits of
/// [`ShearedRay::shear`].
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn along_ray<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    corners: &[CornerBlock],
    ray: &ShearedRay,
    limit: f32,
) -> Survivors {
    let codes = ray_codes(simd, positions, rows, ray, limit);
    survivors(simd, corners, &codes)
}

/// Triangles with a corner in a ball before it moves, by more than rounding; none if the ball is too small or too far
/// out to tell.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn within_ball<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    corners: &[CornerBlock],
    ball: &MovingBall,
) -> Survivors {
    let center = ball.center.map(|x| S::f32s::splat(simd, x));
    let reach = ball.radius * (1.0 - SLACK) - ball.lost;
    // Where the centre is NaN, the loss is infinite.
    if !(LEAST_RADIUS < reach && reach < LARGEST_SIZE) {
        return Survivors([0; MAX_TRIANGLES / BLOCK]);
    }
    let reach_sq = S::f32s::splat(simd, reach * reach * (1.0 - SLACK));
    let codes = each_code(
        simd,
        rows,
        #[cfg_attr(not(unoptimized), inline(always))]
        |slot| {
            let [x, y, z] = vectors::<S>(simd, positions, slot);
            let (x, y, z) = (x - center[0], y - center[1], z - center[2]);
            // Beyond the ball, or about as far as its surface.
            [(x * x + y * y + z * z).simd_ge(reach_sq)]
        },
    );
    survivors(simd, corners, &codes)
}

/// An upper bound of the distance from a point to the nearest of a cluster's vertices.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn nearest_vertex<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    point: [f32; 3],
) -> f32 {
    nearest_square(simd, positions, rows, point).sqrt() * (1.0 + 8.0 * f32::EPSILON)
        + f32::MIN_POSITIVE.sqrt()
}

#[cfg_attr(not(unoptimized), inline(always))]
fn nearest_square<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    point: [f32; 3],
) -> f32 {
    let point = point.map(|x| S::f32s::splat(simd, x));
    let mut nearest = S::f32s::splat(simd, f32::INFINITY);
    for slot in (0..rows * ROW).step_by(S::f32s::LEN) {
        let [x, y, z] = vectors::<S>(simd, positions, slot);
        let (x, y, z) = (x - point[0], y - point[1], z - point[2]);
        let distance = x * x + y * y + z * z;
        nearest = distance.simd_lt(nearest).select(distance, nearest);
    }
    let mut least = f32::INFINITY;
    for distance in nearest.as_slice() {
        least = if *distance < least { *distance } else { least };
    }
    least
}

#[cfg_attr(not(unoptimized), inline(always))]
fn vectors<S: Simd>(simd: S, positions: &ClusterPositions, slot: usize) -> [S::f32s; 3] {
    let vector =
        |axis: &[f32; MAX_SLOTS]| S::f32s::from_slice(simd, &axis[slot..slot + S::f32s::LEN]);
    [
        vector(&positions.0[0]),
        vector(&positions.0[1]),
        vector(&positions.0[2]),
    ]
}

#[cfg_attr(not(unoptimized), inline(always))]
fn plane_codes<S: Simd, const P: usize>(
    simd: S,
    positions: [&ClusterPositions; P],
    rows: usize,
    planes: &Planes<P>,
    until: f32,
) -> Codes {
    let origin = planes.origin.map(|x| S::f32s::splat(simd, x));
    let slack = S::f32s::splat(simd, SLACK);
    let until = S::f32s::splat(simd, until);
    each_code(
        simd,
        rows,
        #[cfg_attr(not(unoptimized), inline(always))]
        |slot| {
            let p = vectors::<S>(simd, positions[0], slot);
            let p = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
            let mut lost = slack * taxicab::<S>(p);
            let mut ends = [p; 2];
            if P == 2 {
                let q = vectors::<S>(simd, positions[P - 1], slot);
                let q = [q[0] - origin[0], q[1] - origin[1], q[2] - origin[2]];
                lost = slack * (taxicab::<S>(p) + taxicab::<S>(q));
                for axis in 0..3 {
                    ends[1][axis] = p[axis] + (q[axis] - p[axis]) * until;
                }
            }
            [
                beyond(simd, planes, 0, ends, lost),
                beyond(simd, planes, 1, ends, lost),
                beyond(simd, planes, 2, ends, lost),
                beyond(simd, planes, 3, ends, lost),
                beyond(simd, planes, 4, ends, lost),
                beyond(simd, planes, 5, ends, lost),
                beyond(simd, planes, 6, ends, lost),
                beyond(simd, planes, 7, ends, lost),
            ]
        },
    )
}

/// Which points lie beyond a plane by more than the allowance `lost` for rounding; moving points have to at both ends
/// of their paths. Points are relative to the planes' origin.
#[cfg_attr(not(unoptimized), inline(always))]
fn beyond<S: Simd, const P: usize>(
    simd: S,
    planes: &Planes<P>,
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
    let limit = S::f32s::splat(simd, planes.limits[0][plane]) + lost;
    let starts = (nx * p[0] + ny * p[1] + nz * p[2]).simd_gt(limit);
    if P == 1 {
        return starts;
    }
    let limit = S::f32s::splat(simd, planes.limits[P - 1][plane]) + lost;
    starts & (nx * q[0] + ny * q[1] + nz * q[2]).simd_gt(limit)
}

#[cfg_attr(not(unoptimized), inline(always))]
fn taxicab<S: Simd>([x, y, z]: [S::f32s; 3]) -> S::f32s {
    x.abs() + y.abs() + z.abs()
}

#[cfg_attr(not(unoptimized), inline(always))]
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
        #[cfg_attr(not(unoptimized), inline(always))]
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

#[cfg_attr(not(unoptimized), inline(always))]
fn ray_codes<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    ray: &ShearedRay,
    limit: f32,
) -> Codes {
    let zero = S::f32s::splat(simd, 0.0);
    let limit = S::f32s::splat(simd, limit);
    let axes = ray.axes;
    let origin = ray.origin.to_array();
    let origin = axes.map(|axis| S::f32s::splat(simd, origin[axis]));
    let shear = ray.shear.map(|x| S::f32s::splat(simd, x));
    each_code(
        simd,
        rows,
        #[cfg_attr(not(unoptimized), inline(always))]
        |slot| {
            let p = vectors::<S>(simd, positions, slot);
            let (x, y, z) = (
                p[axes[0]] - origin[0],
                p[axes[1]] - origin[1],
                p[axes[2]] - origin[2],
            );
            let (x, y, z) = (x - shear[0] * z, y - shear[1] * z, z * shear[2]);
            [
                x.simd_lt(zero),
                y.simd_lt(zero),
                z.simd_lt(zero),
                x.simd_gt(zero),
                y.simd_gt(zero),
                z.simd_gt(limit),
            ]
        },
    )
}

/// A code for every slot. For each vector of slots, `outside` returns which of them lie in each of up to eight
/// half-spaces.
#[cfg_attr(not(unoptimized), inline(always))]
fn each_code<S: Simd, const N: usize>(
    simd: S,
    rows: usize,
    mut outside: impl FnMut(usize) -> [S::mask32s; N],
) -> Codes {
    let mut wide = [0u32; MAX_SLOTS];
    let none = S::u32s::splat(simd, 0);
    for slot in (0..rows * ROW).step_by(S::f32s::LEN) {
        let mut code = none;
        for (bit, mask) in outside(slot).into_iter().enumerate() {
            code |= mask.select(S::u32s::splat(simd, 1 << bit), none);
        }
        code.store_slice(&mut wide[slot..slot + S::f32s::LEN]);
    }
    wide.map(|code| code as u8)
}

/// Triangles whose corners share no bit. The padding after a cluster's last triangle repeats one corner three times, so
/// it may survive: callers stop before it.
#[cfg_attr(not(unoptimized), inline(always))]
fn survivors<S: Simd>(simd: S, corners: &[CornerBlock], codes: &Codes) -> Survivors {
    let mut found = Survivors([0; MAX_TRIANGLES / BLOCK]);
    for (bits, CornerBlock(slots)) in found.0.iter_mut().zip(corners) {
        // Without a byte shuffle, looking codes up one by one is faster.
        *bits = if simd.level().is_fallback() || lacks_shuffle(simd.level()) {
            one_by_one(slots, codes)
        } else {
            let (low, high) = codes.split_at(MAX_SLOTS / 2);
            let (low, high) = (u8x32::from_slice(simd, low), u8x32::from_slice(simd, high));
            let code = |slots: &[u8; BLOCK]| {
                let slots = u8x32::from_slice(simd, slots);
                simd.concat_swizzle_dyn_u8x32(low, high, slots)
            };
            let shared = code(&slots[0]) & code(&slots[1]) & code(&slots[2]);
            shared.simd_eq(u8x32::splat(simd, 0)).to_bitmask() as u32
        };
    }
    found
}

#[cfg_attr(not(unoptimized), inline(always))]
fn lacks_shuffle(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return matches!(level, Level::Sse2(_));
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return false;
}

#[cfg_attr(not(unoptimized), inline(always))]
fn one_by_one(slots: &[[u8; BLOCK]; 3], codes: &Codes) -> u32 {
    let mut bits = 0;
    for triangle in 0..BLOCK {
        let code = |corner: usize| codes[usize::from(slots[corner][triangle]) % MAX_SLOTS];
        bits |= u32::from(code(0) & code(1) & code(2) == 0) << triangle;
    }
    bits
}

/// A moving ball: its centre, its displacement and its radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBall {
    pub(super) center: [f32; 3],
    pub(super) motion: [f32; 3],
    pub(super) radius: f32,
    /// Allowance for error in the position of the centre.
    pub(super) lost: f32,
}

/// A time by which a ball has touched one of a cluster's vertices, close to the earliest such time; infinity if none is
/// found.
///
/// Solves a quadratic for a slightly smaller ball. Rounding may put the root anywhere, so it counts only if the vertex
/// is then within the full ball, less the allowance for rounding.
#[cfg_attr(not(unoptimized), inline(always))]
pub(super) fn touched_by<S: Simd, const P: usize>(
    simd: S,
    positions: [&ClusterPositions; P],
    rows: usize,
    ball: &MovingBall,
) -> f32 {
    earliest(simd, positions, rows, ball)
}

/// Share of the radius by which the ball is reduced for the quadratic. With a smaller share, rounding voids more roots;
/// with a larger one, roots come later.
const SMALLER: f32 = 1.0 / 1024.0;

/// 2^-50. Squares of much smaller lengths underflow.
const LEAST_RADIUS: f32 = 1.0 / (1u64 << 50) as f32;

/// Fourth powers of larger lengths overflow.
const LARGEST_SIZE: f32 = 1e9;

#[cfg_attr(not(unoptimized), inline(always))]
fn earliest<S: Simd, const P: usize>(
    simd: S,
    positions: [&ClusterPositions; P],
    rows: usize,
    ball: &MovingBall,
) -> f32 {
    let number = |x: f32| S::f32s::splat(simd, x);
    let (zero, one, never) = (number(0.0), number(1.0), number(f32::INFINITY));
    let slack = number(SLACK);
    let mut least = never;
    for slot in (0..rows * ROW).step_by(S::f32s::LEN) {
        let p = vectors::<S>(simd, positions[0], slot);
        let (mut from, mut way) = (p, [zero; 3]);
        if P == 2 {
            let q = vectors::<S>(simd, positions[P - 1], slot);
            for axis in 0..3 {
                way[axis] = q[axis] - p[axis];
            }
        }
        for axis in 0..3 {
            from[axis] = p[axis] - number(ball.center[axis]);
            way[axis] -= number(ball.motion[axis]);
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

#[cfg_attr(not(unoptimized), inline(always))]
fn dot<S: Simd>(p: [S::f32s; 3], q: [S::f32s; 3]) -> S::f32s {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}
