//! The bounding spheres of all eight children of a hierarchy node at once, in f32.
//!
//! In the notation of the parent module, for each child: c^ is `sum o_i M_i c` and q^_i is `M_i c`, both as f32
//! arithmetic gives them; `d_i = |q^_i - c^|`; `e_i` are the deviations, which the parent module calls d_i. The
//! sphere about c^ has the radius `min(r max s_i + sum e_i d_i, max (d_i + s_i r))`: weight interval and hull about
//! one centre, over the joints that move the child.
//!
//! This radius is then enlarged to cover the loss by rounding. Let `u = 2^-24`, let `g(k) = k u / (1 - k u)` be the
//! largest relative change of a number by k roundings, let m be the number of joints of the child, let n be the most
//! influences of one of its vertices, and let `D = sum e_i` and `S = max s_i max(|p|, |c|) + max |t_i|`. Then
//! `|M_i||p| + |t_i| <= sqrt(3) S`; the factor comes from the Frobenius norm. There are three kinds of loss:
//!
//! **Relative to S** ([`Node::inflation`], precomputed as a factor of S):
//! - The vertex itself is skinned in f32: `sqrt(3) g(n + 4) S`, see [`crate::skin`].
//! - c^ differs from `c' = sum o_i M_i c`: three roundings in each row of `M_i c`, one for the weight, and at most
//!   m in the sum, in which the `o_i` add up to exactly 1. This is at most `sqrt(3) g(m + 4) S`.
//! - q^_i differs from `M_i c` by at most `sqrt(3) g(3) S`. The differences `w_i - o_i` add up to 0, so in the
//!   second sum of `p' - c' = sum w_i A_i (p - c) + sum (w_i - o_i) (M_i c - c')` any point may replace c', and so
//!   may c^. Hence `|p' - c'| <= r max s_i + sum e_i (d_i + |M_i c - q^_i|)`, which costs `D sqrt(3) g(3) S`. The
//!   hull is taken about c^ as well. This costs nothing for c^ and one `sqrt(3) g(3) S` for q^_i, which is less
//!   than `sqrt(3) g(m + 4) S`.
//!
//! Together: `sqrt(3) (g(n + 4) + g(m + 4) + D g(4)) S`. Computing S, its product with the factor and two sums
//! takes five more roundings: a factor of `1 + 2^-21`.
//!
//! **Relative to the radius** ([`slack`]): d_i has one rounding in its differences, three under the root, which the
//! root halves, and one in the root: 3.5. The product with `e_i` and the sum take m + 1, the sum with `r max s_i` takes
//! one: m + 5.5. The hull has fewer. With the product with the slack and the last sum, m + 7.5 roundings may have made
//! the radius smaller, and `(1 - u)^-k <= 1 + g(k)`. m is at most 2^16, the most joints of a mesh, so `g(k) <= (k + k /
//! 255) u`: the factor is at least `1 + (m + 8 + m / 128) u`.
//!
//! **Absolute** ([`FLOOR`], 2^-56): a product that underflows is off by at most 2^-150; sums lose nothing to
//! underflow. Squares under the root lose `3 2^-150`, so d_i loses at most `sqrt(3) 2^-75`, and the sum loses D
//! times that, with D < 2^16: 2^-58. Everything else (skinning's `sqrt(3) (4 n + 4) 2^-149`, some `4 m` products)
//! is below 2^-128.
//!
//! **Overflow**: positions reach 2^100, so squares may be infinite, and then the radius is infinite. NaN would come
//! from infinity times 0. A deviation of 0 times an infinite distance makes the interval NaN; the comparison then
//! selects the hull. The hull has no such product, because the smallest normal number is added to r.
//!
//! The bits are the same at every [`SimdLevel`]: lanes do not interact, and each does plain IEEE operations in a
//! fixed order.

use fearless_simd::{Simd, dispatch, f32x8, prelude::*};
use glam::Vec3;

use super::JointTable;
use super::joint_table::Joint;
use crate::SimdLevel;
use crate::geometry::Sphere;
use crate::mesh::hierarchy::{Hierarchy, JointWeights, LANES, Node};

/// Added to every radius to cover underflow, in model units: larger than any such loss, and too small to matter.
/// See the module docs.
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
    /// Eight spheres of radius 0 at the origin.
    pub(crate) const ZERO: Self = Self {
        x: [0.0; LANES],
        y: [0.0; LANES],
        z: [0.0; LANES],
        radius: [0.0; LANES],
    };

    /// The sphere of one lane.
    pub(crate) fn sphere(&self, lane: usize) -> Sphere {
        Sphere {
            center: Vec3::new(self.x[lane], self.y[lane], self.z[lane]),
            radius: self.radius[lane],
        }
    }

    /// x, y, z and radius of all lanes.
    pub(crate) fn rows_mut(&mut self) -> [&mut [f32; LANES]; 4] {
        [&mut self.x, &mut self.y, &mut self.z, &mut self.radius]
    }
}

/// The factor that covers the relative rounding error of a radius: at least `1 + (m + 8 + m / 128) 2^-24`, computed
/// exactly.
fn slack(joints: usize) -> f32 {
    1.0 + (joints / 2 + joints / 256 + 6) as f32 * f32::EPSILON
}

/// For each child of a node, a sphere that holds every vertex below the child, as f32 skinning computes it. `table`
/// has read the palette.
///
/// # Panics
/// If a joint is out of the table's range.
pub(crate) fn spheres(
    level: SimdLevel,
    hierarchy: &Hierarchy,
    node: &Node,
    table: &JointTable,
) -> Spheres {
    let mut found = Spheres::ZERO;
    find_spheres(level, hierarchy, node, table, &mut found);
    found
}

/// [`spheres`] where the caller has room for them.
pub(crate) fn find_spheres(
    level: SimdLevel,
    hierarchy: &Hierarchy,
    node: &Node,
    table: &JointTable,
    found: &mut Spheres,
) {
    let (joints, weights) = (node.joints(hierarchy), node.weights(hierarchy));
    dispatch!(level.level(), simd => evaluate(simd, node, joints, weights, table.joints(), found));
}

/// Eight points.
#[derive(Clone, Copy)]
struct Points<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    z: f32x8<S>,
}

#[cfg_attr(not(unoptimized), inline(always))]
fn evaluate<S: Simd>(
    simd: S,
    node: &Node,
    joints: &[u32],
    weights: &[JointWeights],
    table: &[Joint],
    found: &mut Spheres,
) {
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

    // Never 0: the stretch may be infinite, and infinity times 0 is NaN.
    let radius = load(simd, &node.radius) + f32::MIN_POSITIVE;
    let reach = load(simd, &node.reach) + f32::MIN_POSITIVE;
    let (mut deviation_sum, mut hull, mut stretch, mut shift) = (zero, zero, zero, zero);
    for (joint, weights) in joints.iter().zip(weights) {
        let joint = &table[*joint as usize];
        // Computed again, which is cheaper than storing it.
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
    center.x.store_slice(&mut found.x);
    center.y.store_slice(&mut found.y);
    center.z.store_slice(&mut found.z);
    radius.store_slice(&mut found.radius);
}

/// The images of eight points under the matrix of a joint, in the order of the skinning contract.
#[cfg_attr(not(unoptimized), inline(always))]
fn image<S: Simd>(joint: &Joint, p: Points<S>) -> Points<S> {
    let [x, y, z] = &joint.rows;
    Points {
        x: row(x, p),
        y: row(y, p),
        z: row(z, p),
    }
}

#[cfg_attr(not(unoptimized), inline(always))]
fn row<S: Simd>(m: &[f32; 4], p: Points<S>) -> f32x8<S> {
    (p.x * m[0] + p.y * m[1]) + (p.z * m[2] + m[3])
}

#[cfg_attr(not(unoptimized), inline(always))]
fn load<S: Simd>(simd: S, lanes: &[f32; LANES]) -> f32x8<S> {
    f32x8::simd_from(simd, *lanes)
}

/// The larger number of each lane, by comparison, because `max` differs between instruction sets.
#[cfg_attr(not(unoptimized), inline(always))]
fn larger<S: Simd>(a: f32x8<S>, b: f32x8<S>) -> f32x8<S> {
    b.simd_gt(a).select(b, a)
}

#[cfg(test)]
mod tests;
