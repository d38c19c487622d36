//! The corners of a moving triangle, stored by coordinate, so that the compiler turns loops over them into SIMD
//! instructions.

use clamber_surface::surface::MovingTriangle;
use glam::{Mat3, Vec3};

/// Number of points: the corners of a triangle before and after its motion, each time with the first one twice.
const LANES: usize = 8;

/// One number for each point.
type Lanes = [f32; LANES];

/// A transform of the corners before the motion, and one of the corners after it, in rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transforms {
    rows: [[Lanes; 3]; 3],
    shift: [Lanes; 3],
}

impl Transforms {
    pub(super) fn new([before, after]: [(Mat3, Vec3); 2]) -> Self {
        let mut all = Self {
            rows: [[[0.0; LANES]; 3]; 3],
            shift: [[0.0; LANES]; 3],
        };
        for lane in 0..LANES {
            let (turn, shift) = if lane < LANES / 2 { before } else { after };
            for row in 0..3 {
                for column in 0..3 {
                    all.rows[row][column][lane] = turn.col(column)[row];
                }
                all.shift[row][lane] = shift[row];
            }
        }
        all
    }
}

/// The corners of a moving triangle in the body's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners([Lanes; 3]);

impl Corners {
    #[inline(always)]
    pub(super) fn new(moving: &MovingTriangle, transforms: &Transforms) -> Self {
        let [a, b, c] = &moving.previous;
        let [d, e, f] = &moving.current;
        let x = [a.x, b.x, c.x, a.x, d.x, e.x, f.x, d.x];
        let y = [a.y, b.y, c.y, a.y, d.y, e.y, f.y, d.y];
        let z = [a.z, b.z, c.z, a.z, d.z, e.z, f.z, d.z];
        let mut all = [[0.0; LANES]; 3];
        for (row, own) in all.iter_mut().enumerate() {
            let ([p, q, r], shift) = (&transforms.rows[row], &transforms.shift[row]);
            for lane in 0..LANES {
                own[lane] = p[lane] * x[lane] + q[lane] * y[lane] + r[lane] * z[lane] + shift[lane];
            }
        }
        Self(all)
    }

    /// A corner before the motion.
    #[inline(always)]
    pub(super) fn before(&self, corner: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[corner % 4], y[corner % 4], z[corner % 4])
    }

    /// The low and the high corner of the box around the corners.
    #[inline(always)]
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        let [x, y, z] = &self.0;
        let ((low_x, high_x), (low_y, high_y), (low_z, high_z)) = (span(x), span(y), span(z));
        (
            Vec3::new(low_x, low_y, low_z),
            Vec3::new(high_x, high_y, high_z),
        )
    }

    /// The least and the largest dot product with a direction.
    #[inline(always)]
    pub(super) fn along(&self, direction: Vec3) -> (f32, f32) {
        let [x, y, z] = &self.0;
        let mut dots = [0.0; LANES];
        for lane in 0..LANES {
            dots[lane] = direction.x * x[lane] + direction.y * y[lane] + direction.z * z[lane];
        }
        span(&dots)
    }

    /// The largest distance from the origin.
    #[inline(always)]
    pub(super) fn farthest(&self) -> f32 {
        let [x, y, z] = &self.0;
        let mut squares = [0.0; LANES];
        for lane in 0..LANES {
            squares[lane] = x[lane] * x[lane] + y[lane] * y[lane] + z[lane] * z[lane];
        }
        span(&squares).1.sqrt()
    }

    /// The largest distance between a corner before and after the motion.
    #[inline(always)]
    pub(super) fn most_moved(&self) -> f32 {
        let mut squares = [0.0; LANES / 2];
        for axis in &self.0 {
            for lane in 0..LANES / 2 {
                let moved = axis[lane + LANES / 2] - axis[lane];
                squares[lane] += moved * moved;
            }
        }
        let [a, b, c, _] = squares;
        a.max(b).max(c).sqrt()
    }
}

/// The least and the largest of eight numbers.
#[inline(always)]
fn span(lanes: &Lanes) -> (f32, f32) {
    let (mut low, mut high) = ([0.0; LANES / 2], [0.0; LANES / 2]);
    for lane in 0..LANES / 2 {
        let (a, b) = (lanes[lane], lanes[lane + LANES / 2]);
        low[lane] = if a < b { a } else { b };
        high[lane] = if a > b { a } else { b };
    }
    let least = |a: f32, b: f32| if a < b { a } else { b };
    let most = |a: f32, b: f32| if a > b { a } else { b };
    (
        least(least(low[0], low[1]), low[2]),
        most(most(high[0], high[1]), high[2]),
    )
}
