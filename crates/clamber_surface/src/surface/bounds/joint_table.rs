use glam::DMat3;

use super::joint_maps::StretchPower;
use crate::geometry::Affine;

/// What the eight-wide bounds read of a palette: one cache line a joint. Computed once a palette,
/// for all nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointTable {
    joints: Vec<Joint>,
    /// Of the same joints; kept for its memory alone.
    squares: Vec<Squares>,
}

/// What a joint's lengths are roots of.
#[derive(Clone, Copy, Debug)]
struct Squares {
    stretch: Stretch,
    shift: f64,
}

/// What bounds a joint's stretch, before its roots.
#[derive(Clone, Copy, Debug)]
enum Stretch {
    /// Its square, of a matrix whose columns stand nearly at right angles: a joint that turns, and
    /// scales along its axes.
    Square(f64),
    /// Of any other.
    Power(StretchPower),
}

/// Columns stand nearly at right angles if the products of pairs of them are below this share of the
/// longest one's square. The bound is then at most half as much too large.
const NEARLY_RIGHT_ANGLES: f64 = 1e-3;

/// One joint's matrix, and how much it stretches and moves at most.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) rows: [[f32; 4]; 3],
    /// At least the largest singular value of the linear part, at most 1.04 times it but for
    /// rounding; infinite where no f32 is as large.
    pub(super) stretch: f32,
    /// At least the length of the translation.
    pub(super) shift: f32,
}

/// Relative error of a length computed in f64, with room to spare.
const LENGTH_SLACK: f64 = 2e-15;

impl JointTable {
    /// Reads a palette that a surface accepts. Keeps its memory: a palette of the same length
    /// allocates nothing.
    pub(crate) fn update(&mut self, palette: &[Affine]) {
        self.joints.clear();
        self.squares.clear();
        // Two loops: in one the processor waits for each joint's roots before it begins the next
        // but one, which takes twice the time.
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
    /// The largest singular value's square is at most any norm of `A^T A`; of the rows' sums here,
    /// which for right angles is that square itself.
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

/// The smallest f32 that is not below `x`, which is not negative. Without a branch, which would be
/// mispredicted every other time.
fn round_up(x: f64) -> f32 {
    let nearest = x as f32;
    f32::from_bits(nearest.to_bits() + u32::from(f64::from(nearest) < x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::round_up_to_f32;

    #[test]
    fn rounding_up_is_that_of_all_others() {
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
}
