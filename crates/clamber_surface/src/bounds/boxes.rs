//! Boxes around the children of a node, fitted to skinned positions.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::Spheres;
use crate::mesh::hierarchy::LANES;

/// Eight boxes along the axes, in model space. A lane without a child, or with dead clusters only, holds an empty box:
/// one point far away from everything.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Boxes {
    /// The lowest x, y and z of each lane.
    pub(crate) low: [[f32; LANES]; 3],
    pub(crate) high: [[f32; LANES]; 3],
}

/// The coordinates of an empty box: far from any position, and its square overflows.
const NOWHERE: f32 = 1e38;

impl Boxes {
    /// Eight empty boxes.
    pub(crate) const EMPTY: Self = Self {
        low: [[NOWHERE; LANES]; 3],
        high: [[NOWHERE; LANES]; 3],
    };

    pub(crate) fn set(&mut self, lane: usize, [low, high]: [[f32; 3]; 2]) {
        for axis in 0..3 {
            self.low[axis][lane] = low[axis];
            self.high[axis][lane] = high[axis];
        }
    }

    /// The box around all boxes that are not empty; `None` if all boxes are empty.
    pub(crate) fn union(&self) -> Option<[[f32; 3]; 2]> {
        let (mut lowest, mut highest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let sides = lowest.iter_mut().zip(&mut highest);
        for ((lowest, highest), lanes) in sides.zip(self.low.iter().zip(&self.high)) {
            for (low, high) in lanes.0.iter().zip(lanes.1) {
                if *low < NOWHERE {
                    *lowest = lowest.min(*low);
                    *highest = highest.max(*high);
                }
            }
        }
        (lowest[0] <= highest[0]).then_some([lowest, highest])
    }

    /// Spheres around the boxes. The radius is infinite if a box is empty, or too large to be squared.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(crate) fn spheres<S: Simd>(&self, simd: S) -> Spheres {
        let zero = f32x8::splat(simd, 0.0);
        let (mut centers, mut square) = ([zero; 3], zero);
        for (axis, center) in centers.iter_mut().enumerate() {
            let low = f32x8::simd_from(simd, self.low[axis]) * 0.5;
            let high = f32x8::simd_from(simd, self.high[axis]) * 0.5;
            *center = low + high;
            // Halving an f32 is exact unless it underflows. The slack covers that.
            let half = high - low;
            let size = low.abs() + high.abs();
            let half = half + size * SLACK + f32::MIN_POSITIVE;
            square += half * half;
        }
        let [x, y, z] = centers;
        let radius = square.sqrt() * (1.0 + SLACK) + LEAST_RADIUS;
        Spheres {
            x: *x,
            y: *y,
            z: *z,
            radius: *radius,
        }
    }
}

/// Allowance for rounding, as a share of a sphere's radius, and of the coordinates for its centre. It is more than all
/// roundings together.
const SLACK: f32 = 4.0 * f32::EPSILON;

/// 2^-56, added to every radius as in bounds from the palette. Squares that underflow are smaller.
const LEAST_RADIUS: f32 = 1.0 / (1u64 << 56) as f32;
