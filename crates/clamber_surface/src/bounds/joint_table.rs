use glam::DMat3;

use crate::geometry::Affine;

/// The data of a palette that the eight-wide bounds read, one cache line per joint. Computed once per palette, for
/// all nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointTable {
    joints: Vec<Joint>,
    /// Intermediate values of the same joints. Stored only to reuse the memory.
    squares: Vec<Squares>,
}

/// Values computed for a joint before roots are taken.
#[derive(Clone, Copy, Debug)]
struct Squares {
    stretch: Stretch,
    shift: f64,
}

/// An upper bound of a joint's stretch, before its root is taken.
#[derive(Clone, Copy, Debug)]
enum Stretch {
    /// The square of the bound, for a matrix whose columns are nearly perpendicular: a joint that rotates, and
    /// scales along its own axes.
    Square(f64),
    /// For any other matrix.
    Power(StretchPower),
}

/// Columns count as nearly perpendicular if the absolute dot products of their pairs add up to at most this share
/// of the longest column's square. The bound is then too large by at most half of this share.
const NEARLY_RIGHT_ANGLES: f64 = 1e-3;

/// One joint's matrix, and upper bounds of how much it stretches and translates.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) rows: [[f32; 4]; 3],
    /// An upper bound of the largest singular value of the linear part: at most 1.04 times that value, but for
    /// rounding. Infinite if no finite f32 is large enough.
    pub(super) stretch: f32,
    /// An upper bound of the length of the translation.
    pub(super) shift: f32,
}

/// More than the relative error of a length computed in f64.
const LENGTH_SLACK: f64 = 2e-15;

impl JointTable {
    /// Reads a palette that a surface accepted. Reuses its memory: a palette of the same length allocates nothing.
    pub(crate) fn update(&mut self, palette: &[Affine]) {
        self.joints.clear();
        self.squares.clear();
        // Two loops. In a single loop the processor waits for the roots of each joint before it begins the next but
        // one, which takes twice the time.
        self.squares.extend(palette.iter().map(Squares::new));
        let joints = palette.iter().zip(&self.squares);
        self.joints.extend(joints.map(|(matrix, squares)| Joint {
            rows: matrix.rows,
            stretch: round_up(squares.stretch.root()),
            shift: round_up(squares.shift.sqrt() * (1.0 + LENGTH_SLACK)),
        }));
    }

    pub(super) fn joints(&self) -> &[Joint] {
        &self.joints
    }
}

impl Squares {
    fn new(matrix: &Affine) -> Self {
        let map = matrix.to_f64();
        Self {
            stretch: Stretch::new(&map.matrix3),
            // Squares of f32 numbers neither under- nor overflow in f64.
            shift: map.translation.length_squared(),
        }
    }
}

impl Stretch {
    /// The square of the largest singular value is at most any induced norm of `A^T A`. The norm taken here is the
    /// largest sum of a row's absolute values. For perpendicular columns it equals that square.
    fn new(linear: &DMat3) -> Self {
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let (xx, yy, zz) = (x.dot(x), y.dot(y), z.dot(z));
        let (xy, xz, yz) = (x.dot(y).abs(), x.dot(z).abs(), y.dot(z).abs());
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        if xy + xz + yz <= larger(larger(xx, yy), zz) * NEARLY_RIGHT_ANGLES {
            Self::Square(larger(larger(xx + xy + xz, yy + xy + yz), zz + xz + yz))
        } else {
            Self::Power(StretchPower::new(linear))
        }
    }

    fn root(self) -> f64 {
        match self {
            Self::Square(square) => square.sqrt() * (1.0 + LENGTH_SLACK),
            Self::Power(power) => power.root(),
        }
    }
}

/// More than the relative error of the computed bound: some 90 roundings of 2^-53. The eighth root reduces this error
/// to one eighth.
const STRETCH_SLACK: f64 = 1e-14;

/// The exponent bits of an f64. A positive number masked by them is the largest power of two that is not above it.
const EXPONENT: u64 = 0x7ff << 52;

/// This minus the bits of a power of two gives the bits of its inverse.
const INVERSE: u64 = 2046 << 52;

/// `(norm_inf((A^T A)^4))^(1/8)`, rounded up: at least the largest singular value of A, and at most
/// `((1 + sqrt(3)) / 2)^(1/8)`, 1.04, times it. Exact but for rounding where A is a rotation times a
/// uniform scale.
///
/// The largest eigenvalue of `A^T A` is the square of that singular value, and any induced norm is at least the
/// largest eigenvalue. First, A is scaled by a power of two, which is exact, to elements below 2. So no eighth
/// power overflows, and none that matters underflows.
///
/// This type holds the values before the roots are taken. The roots take as long as the rest. With the roots in a
/// separate pass, the processor works on the rest of several joints at a time.
#[derive(Clone, Copy, Debug)]
struct StretchPower {
    /// A power of two, or the bound itself if that is 0 or not finite.
    scale: f64,
    /// `norm_inf((A^T A)^4)` for A divided by `scale`.
    norm: f64,
}

impl StretchPower {
    fn new(linear: &DMat3) -> Self {
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
        let [x, y, z] = columns.map(|c| c.abs());
        // Not `f64::max`: its handling of NaN takes longer than the rest of this function.
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let [x, y, z] = [x, y, z].map(|c| larger(larger(c.x, c.y), c.z));
        let largest = larger(larger(x, y), z);
        if !(largest > 0.0 && largest < f64::MAX) {
            return Self {
                scale: largest,
                norm: 1.0,
            };
        }
        let exponent = largest.to_bits() & EXPONENT;
        let inverse = f64::from_bits(INVERSE - exponent);
        let [x, y, z] = columns.map(|c| c * inverse);
        let squared = square(&[x.dot(x), y.dot(y), z.dot(z), x.dot(y), x.dot(z), y.dot(z)]);
        let [xx, yy, zz, xy, xz, yz] = square(&squared).map(f64::abs);
        Self {
            scale: f64::from_bits(exponent),
            norm: larger(larger(xx + xy + xz, xy + yy + yz), xz + yz + zz),
        }
    }

    fn root(self) -> f64 {
        self.scale * self.norm.sqrt().sqrt().sqrt() * (1.0 + STRETCH_SLACK)
    }
}

/// The square of a symmetric matrix: elements xx, yy, zz, xy, xz, yz.
fn square(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> [f64; 6] {
    [
        xx * xx + xy * xy + xz * xz,
        xy * xy + yy * yy + yz * yz,
        xz * xz + yz * yz + zz * zz,
        xx * xy + xy * yy + xz * yz,
        xx * xz + xy * yz + xz * zz,
        xy * xz + yy * yz + yz * zz,
    ]
}

/// The smallest f32 that is not below `x`. `x` must not be negative. There is no branch, since it would be
/// mispredicted every other time.
fn round_up(x: f64) -> f32 {
    let nearest = x as f32;
    f32::from_bits(nearest.to_bits() + u32::from(f64::from(nearest) < x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::round_up_to_f32;
    use crate::testing::{direction, point};
    use glam::DVec3;

    #[test]
    fn branchless_rounding_up_agrees_with_round_up_to_f32() {
        let mut rng = fastrand::Rng::with_seed(63);
        for x in [
            0.0,
            1e-60,
            1e-45,
            1.0,
            3.4e38,
            3.5e38,
            f64::MAX,
            f64::INFINITY,
        ] {
            assert_eq!(round_up(x).to_bits(), round_up_to_f32(x).to_bits(), "{x}");
        }
        for _ in 0..100_000 {
            let x = f64::from(f32::from_bits(rng.u32(0..0x7f80_0000))) * (1.0 + rng.f64());
            assert_eq!(round_up(x).to_bits(), round_up_to_f32(x).to_bits(), "{x}");
        }
    }

    /// The largest singular value by power iteration: a lower bound.
    fn stretch_reference(linear: &DMat3, start: DVec3) -> f64 {
        let size = linear
            .to_cols_array()
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let scaled = DMat3::from_cols_array(&linear.to_cols_array().map(|x| x / size));
        let mut v = start;
        for _ in 0..200 {
            v = (scaled.transpose() * (scaled * v)).normalize();
        }
        (scaled * v).length() * size
    }

    #[test]
    fn stretch_is_never_below_the_singular_value_nor_far_above() {
        let mut rng = fastrand::Rng::with_seed(41);
        for case in 0..20_000 {
            let scale = [1e-45, 1e-40, 1e-20, 1.0, 1e20, 1.2e30][case % 6];
            let mut column = || (point(&mut rng, 1.0) * scale).as_dvec3();
            let mut linear = DMat3::from_cols(column(), column(), column());
            if case % 5 == 0 {
                linear.y_axis = linear.x_axis;
                linear.z_axis = -linear.x_axis;
            }
            if linear == DMat3::ZERO {
                assert_eq!(StretchPower::new(&linear).root(), 0.0);
                continue;
            }
            let exact = stretch_reference(&linear, direction(&mut rng).as_dvec3());
            let bound = StretchPower::new(&linear).root();
            assert!(
                bound >= exact * (1.0 - 1e-15),
                "{linear}: {bound} < {exact}"
            );
            assert!(bound <= exact * 1.0399, "{linear}: {bound} against {exact}");
        }
    }

    #[test]
    fn the_bound_of_a_uniform_scale_is_exact() {
        for scale in [1e-45f32, 1e-20, 1.0, 3.0, 1e30] {
            let scale = f64::from(scale);
            let bound = StretchPower::new(&DMat3::from_diagonal(DVec3::splat(-scale))).root();
            assert!(
                bound >= scale && bound <= scale * (1.0 + 3e-14),
                "{scale}: {bound}"
            );
        }
    }
}
