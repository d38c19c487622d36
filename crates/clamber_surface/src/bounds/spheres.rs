//! The bounding spheres of all eight children of a hierarchy node at once, in f32.
//!
//! For each child, with the words of the parent module: c^ = `sum o_i M_i c` and the `M_i c` as f32
//! arithmetic gives them, q^_i below, `d_i = |q^_i - c^|`, and a sphere about c^ of radius
//! `min(r max s_i + sum e_i d_i, max (d_i + s_i r))`: weight interval and hull about one centre, over
//! the joints that move the child. `e_i` are the deviations, called d_i in the parent module.
//! It is then made larger by what arithmetic may have lost. Let `u = 2^-24`,
//! `g(k) = k u / (1 - k u)`, the most that k roundings change a number by relative to it, m the
//! joints of the child, n the most influences of one of its vertices, `D = sum e_i`, and
//! `S = max s_i max(|p|, |c|) + max |t_i|`, which is at least `|M_i||p| + |t_i|` but for a factor
//! `sqrt(3)` (that of Frobenius' norm). Three kinds of loss:
//!
//! **Relative to S** ([`Node::inflation`], precomputed as a factor of S):
//! - The vertex itself is skinned in f32: `sqrt(3) g(n + 4) S`, see [`crate::skin`].
//! - c^ is not `c' = sum o_i M_i c`: three roundings in a row, one by the weight, at most m in the
//!   sum, in which the `o_i` add up to exactly 1: `sqrt(3) g(m + 4) S`.
//! - q^_i is not `M_i c`: `sqrt(3) g(3) S`. The differences `w_i - o_i` add up to 0, so any point
//!   may stand for c' in `p' - c' = sum w_i A_i (p - c) + sum (w_i - o_i) (M_i c - c')`, also c^;
//!   hence `|p' - c'| <= r max s_i + sum e_i (d_i + |M_i c - q^_i|)`, which costs
//!   `D sqrt(3) g(3) S`. The hull is taken about c^ as well: nothing for c^, and one
//!   `sqrt(3) g(3) S`, which is less than `sqrt(3) g(m + 4) S`.
//!
//! Together `sqrt(3) (g(n + 4) + g(m + 4) + D g(4)) S`. S, its product with the factor and two sums
//! are five roundings more: a factor of `1 + 2^-21`.
//!
//! **Relative to the radius** ([`slack`]): d_i passes one rounding in its differences, three under
//! the root, of which that leaves half, one in the root: 3.5. The product with `e_i` and the sum make
//! m + 1, that with `r max s_i` one: m + 5.5. The hull has fewer. The product with the slack and the
//! last sum: m + 7.5 roundings that may have made it smaller, and `(1 - u)^-k <= 1 + g(k)`. m is at
//! most 2^16, so `g(k) <= (k + k / 255) u`: the factor is at least `1 + (m + 8 + m / 128) u`.
//!
//! **Absolute** ([`FLOOR`], 2^-56): a product that underflows is off by 2^-150 at most, a sum never.
//! Squares under the root lose `3 2^-150`, so d_i at most `sqrt(3) 2^-75`, and the sum D times that,
//! D < 2^16: 2^-58. All else (skinning's `sqrt(3) (4 n + 4) 2^-149`, some `4 m` products) is below
//! 2^-128.
//!
//! **Overflow**: positions reach 2^100, so squares may be infinite, and the radius is infinite then.
//! NaN would come from an infinity times 0. A deviation of 0 times an infinite distance makes the
//! interval NaN: the comparison then takes the hull, which has no such product, since r has the
//! smallest normal number added to it.
//!
//! Same bits at every [`SimdLevel`]: lanes never meet, and each does plain IEEE operations in one
//! order.

use fearless_simd::{Simd, dispatch, f32x8, prelude::*};
use glam::Vec3;

use super::JointTable;
use super::joint_table::Joint;
use crate::SimdLevel;
use crate::geometry::Sphere;
use crate::mesh::hierarchy::{Hierarchy, JointWeights, LANES, Node};

/// Pays for underflow, in metres: less than an atom's nucleus, more than any loss. See above.
const FLOOR: f32 = f32::from_bits((127 - 56) << 23);

/// Centres and radii of eight spheres, in model space. A radius may be infinite, never NaN; lanes
/// without a child hold some small sphere.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spheres {
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
    pub(crate) z: [f32; LANES],
    pub(crate) radius: [f32; LANES],
}

impl Spheres {
    /// Points at the origin.
    pub(crate) const ZERO: Self = Self {
        x: [0.0; LANES],
        y: [0.0; LANES],
        z: [0.0; LANES],
        radius: [0.0; LANES],
    };

    /// That of one lane.
    pub(crate) fn sphere(&self, lane: usize) -> Sphere {
        Sphere {
            center: Vec3::new(self.x[lane], self.y[lane], self.z[lane]),
            radius: self.radius[lane],
        }
    }

    /// x, y, z and radius of all lanes.
    pub(crate) fn rows(&self) -> [&[f32; LANES]; 4] {
        [&self.x, &self.y, &self.z, &self.radius]
    }

    /// [`Spheres::rows`] to write to.
    pub(crate) fn rows_mut(&mut self) -> [&mut [f32; LANES]; 4] {
        [&mut self.x, &mut self.y, &mut self.z, &mut self.radius]
    }
}

/// What makes good the roundings of a radius: at least `1 + (m + 8 + m / 128) 2^-24`, exact.
fn slack(joints: usize) -> f32 {
    1.0 + (joints / 2 + joints / 256 + 6) as f32 * f32::EPSILON
}

/// Spheres that hold every vertex below each child of a node as f32 skinning yields it. `table` has read the palette.
///
/// # Panics
/// If a joint is out of the table's range.
pub(crate) fn spheres(
    level: SimdLevel,
    hierarchy: &Hierarchy,
    node: &Node,
    table: &JointTable,
) -> Spheres {
    let (joints, weights) = (node.joints(hierarchy), node.weights(hierarchy));
    dispatch!(level.level(), simd => evaluate(simd, node, joints, weights, table.joints()))
}

/// Eight points.
#[derive(Clone, Copy)]
struct Points<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    z: f32x8<S>,
}

#[inline(always)]
fn evaluate<S: Simd>(
    simd: S,
    node: &Node,
    joints: &[u32],
    weights: &[JointWeights],
    table: &[Joint],
) -> Spheres {
    let zero = f32x8::splat(simd, 0.0);
    let rest = Points {
        x: load(simd, &node.x),
        y: load(simd, &node.y),
        z: load(simd, &node.z),
    };
    let mut center = Points {
        x: zero,
        y: zero,
        z: zero,
    };
    for (joint, weights) in joints.iter().zip(weights) {
        let image = image(&table[*joint as usize], rest);
        let middle = load(simd, &weights.middle);
        center.x += middle * image.x;
        center.y += middle * image.y;
        center.z += middle * image.z;
    }

    // Never 0: the stretch may be infinite.
    let radius = load(simd, &node.radius) + f32::MIN_POSITIVE;
    let reach = load(simd, &node.reach) + f32::MIN_POSITIVE;
    let (mut deviation_sum, mut hull, mut stretch, mut shift) = (zero, zero, zero, zero);
    for (joint, weights) in joints.iter().zip(weights) {
        let joint = &table[*joint as usize];
        // Computed again: cheaper than any place to keep it.
        let image = image(joint, rest);
        let (x, y, z) = (image.x - center.x, image.y - center.y, image.z - center.z);
        let distance = ((x * x + y * y) + z * z).sqrt();
        let deviation = load(simd, &weights.deviation);
        deviation_sum += deviation * distance;
        let moves = (load(simd, &weights.middle) + deviation).simd_gt(zero);
        let only_moved = |value: f32x8<S>| moves.select(value, zero);
        hull = larger(hull, only_moved(distance + radius * joint.stretch));
        stretch = larger(stretch, only_moved(f32x8::splat(simd, joint.stretch)));
        shift = larger(shift, only_moved(f32x8::splat(simd, joint.shift)));
    }

    let interval = radius * stretch + deviation_sum;
    // The hull if the interval is NaN.
    let smaller = interval.simd_lt(hull).select(interval, hull);
    let lost = load(simd, &node.inflation) * (stretch * reach + shift) + FLOOR;
    let radius = smaller * slack(joints.len()) + lost;
    let infinite = f32x8::splat(simd, f32::INFINITY);
    let radius = radius.simd_ge(zero).select(radius, infinite);
    Spheres {
        x: *center.x,
        y: *center.y,
        z: *center.z,
        radius: *radius,
    }
}

/// Where a joint takes eight points, in the order of the skinning contract.
#[inline(always)]
fn image<S: Simd>(joint: &Joint, p: Points<S>) -> Points<S> {
    let [x, y, z] = &joint.rows;
    Points {
        x: row(x, p),
        y: row(y, p),
        z: row(z, p),
    }
}

#[inline(always)]
fn row<S: Simd>(m: &[f32; 4], p: Points<S>) -> f32x8<S> {
    (p.x * m[0] + p.y * m[1]) + (p.z * m[2] + m[3])
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32; LANES]) -> f32x8<S> {
    f32x8::simd_from(simd, *lanes)
}

/// By comparison: `max` differs between instruction sets.
#[inline(always)]
fn larger<S: Simd>(a: f32x8<S>, b: f32x8<S>) -> f32x8<S> {
    b.simd_gt(a).select(b, a)
}

#[cfg(test)]
mod tests;
