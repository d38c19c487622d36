//! Which triangles of a posed cluster are worth an exact test.
//!
//! Every vertex gets a code with a bit for each half-space that it lies in, beyond a plane that
//! touches the query's region, or beside its ray; a triangle whose corners share a bit is outside as well (Cohen and Sutherland's
//! line clipping; Foley, van Dam, Feiner, Hughes 1990, *Computer Graphics*, 3.12). Codes are computed
//! for as many vertices at once as the machine is wide, and looked up for 32 triangles at once.

use fearless_simd::{Level, Select, Simd, SimdBase, SimdMask, dispatch, u8x32};

use super::planes::{self, Planes};
use crate::geometry::triangle::ShearedRay;
use crate::mesh::clusters::{BLOCK, CornerBlock, MAX_SLOTS, MAX_TRIANGLES, ROW};
use crate::simd::SimdLevel;
use crate::skin::ClusterPositions;

/// A bit for each triangle of a cluster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Survivors([u32; MAX_TRIANGLES / BLOCK]);

impl Survivors {
    /// Triangles by ascending number.
    pub(super) fn iter(self) -> impl Iterator<Item = usize> {
        self.0
            .into_iter()
            .enumerate()
            .flat_map(|(block, mut bits)| {
                std::iter::from_fn(move || {
                    let bit = bits.trailing_zeros() as usize;
                    bits &= bits.wrapping_sub(1);
                    (bit < BLOCK).then_some(block * BLOCK + bit)
                })
            })
    }
}

/// A code per slot.
pub(super) type Codes = [u8; MAX_SLOTS];

/// Triangles that no plane rules out.
pub(super) fn within_planes(
    level: SimdLevel,
    positions: &ClusterPositions,
    rows: usize,
    corners: &[CornerBlock],
    planes: &Planes,
) -> Survivors {
    dispatch!(level.level(), simd => {
        let codes = plane_codes(simd, positions, rows, planes);
        survivors(simd, corners, &codes)
    })
}

/// Triangles that a ray as far as `limit` may meet; `sheared` gets the sheared positions, with the
/// bits of [`ShearedRay::shear`].
pub(super) fn along_ray(
    level: SimdLevel,
    positions: &ClusterPositions,
    rows: usize,
    corners: &[CornerBlock],
    ray: &ShearedRay,
    limit: f32,
    sheared: &mut ClusterPositions,
) -> Survivors {
    dispatch!(level.level(), simd => {
        let codes = ray_codes(simd, positions, rows, ray, limit, sheared);
        survivors(simd, corners, &codes)
    })
}

/// At least the distance from a point to the nearest of a cluster's vertices.
pub(super) fn nearest_vertex(
    level: SimdLevel,
    positions: &ClusterPositions,
    rows: usize,
    point: [f32; 3],
) -> f32 {
    dispatch!(level.level(), simd => nearest_square(simd, positions, rows, point)).sqrt()
        * (1.0 + 8.0 * f32::EPSILON)
        + f32::MIN_POSITIVE.sqrt()
}

#[inline(always)]
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

#[inline(always)]
pub(super) fn vectors<S: Simd>(simd: S, positions: &ClusterPositions, slot: usize) -> [S::f32s; 3] {
    let vector =
        |axis: &[f32; MAX_SLOTS]| S::f32s::from_slice(simd, &axis[slot..slot + S::f32s::LEN]);
    [
        vector(&positions.0[0]),
        vector(&positions.0[1]),
        vector(&positions.0[2]),
    ]
}

#[inline(always)]
fn plane_codes<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    planes: &Planes,
) -> Codes {
    let origin = planes.origin.map(|x| S::f32s::splat(simd, x));
    let slack = S::f32s::splat(simd, planes::SLACK);
    each_code(
        simd,
        rows,
        #[inline(always)]
        |slot| {
            let p = vectors::<S>(simd, positions, slot);
            let p = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
            let lost = slack * (p[0].abs() + p[1].abs() + p[2].abs());
            [
                beyond(simd, planes, 0, p, lost),
                beyond(simd, planes, 1, p, lost),
                beyond(simd, planes, 2, p, lost),
                beyond(simd, planes, 3, p, lost),
                beyond(simd, planes, 4, p, lost),
                beyond(simd, planes, 5, p, lost),
                beyond(simd, planes, 6, p, lost),
                beyond(simd, planes, 7, p, lost),
            ]
        },
    )
}

/// Which of some points, relative to the planes' origin, lie beyond a plane for all that is lost.
#[inline(always)]
fn beyond<S: Simd>(
    simd: S,
    planes: &Planes,
    plane: usize,
    [x, y, z]: [S::f32s; 3],
    lost: S::f32s,
) -> S::mask32s {
    let [nx, ny, nz] = &planes.normals;
    let (nx, ny, nz) = (
        S::f32s::splat(simd, nx[plane]),
        S::f32s::splat(simd, ny[plane]),
        S::f32s::splat(simd, nz[plane]),
    );
    let limit = S::f32s::splat(simd, planes.limits[plane]) + lost;
    (nx * x + ny * y + nz * z).simd_gt(limit)
}

#[inline(always)]
fn ray_codes<S: Simd>(
    simd: S,
    positions: &ClusterPositions,
    rows: usize,
    ray: &ShearedRay,
    limit: f32,
    sheared: &mut ClusterPositions,
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
        #[inline(always)]
        |slot| {
            let p = vectors::<S>(simd, positions, slot);
            let (x, y, z) = (
                p[axes[0]] - origin[0],
                p[axes[1]] - origin[1],
                p[axes[2]] - origin[2],
            );
            let (x, y, z) = (x - shear[0] * z, y - shear[1] * z, z * shear[2]);
            for (axis, vector) in [x, y, z].into_iter().enumerate() {
                vector.store_slice(&mut sheared.0[axis][slot..slot + S::f32s::LEN]);
            }
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

/// A code for every slot from what up to eight half-spaces hold of each vector of slots.
#[inline(always)]
pub(super) fn each_code<S: Simd, const N: usize>(
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

/// Triangles whose corners share no bit. What lies beyond a cluster's last triangle has thrice the
/// same corner, and survives if that does: callers know where to stop.
#[inline(always)]
pub(super) fn survivors<S: Simd>(simd: S, corners: &[CornerBlock], codes: &Codes) -> Survivors {
    let mut found = Survivors([0; MAX_TRIANGLES / BLOCK]);
    for (bits, CornerBlock(slots)) in found.0.iter_mut().zip(corners) {
        // Without a byte shuffle, looking codes up one by one is faster.
        *bits = if matches!(simd.level(), Level::Fallback(_)) || lacks_shuffle(simd.level()) {
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

#[inline(always)]
fn lacks_shuffle(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return matches!(level, Level::Sse2(_));
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return false;
}

#[inline(always)]
fn one_by_one(slots: &[[u8; BLOCK]; 3], codes: &Codes) -> u32 {
    let mut bits = 0;
    for triangle in 0..BLOCK {
        let code = |corner: usize| codes[usize::from(slots[corner][triangle]) % MAX_SLOTS];
        bits |= u32::from(code(0) & code(1) & code(2) == 0) << triangle;
    }
    bits
}
