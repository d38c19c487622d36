use glam::{Affine3, DAffine3, DMat3, DVec3, Vec3};
#[expect(clippy::disallowed_types, reason = "other engines use these types")]
use glam::{Affine3A, Mat4};

use super::widen;

/// An affine map in f32, stored row by row.
///
/// Row `r` maps `(x, y, z)` to `((m0 x + m1 y) + (m2 z + m3))`, in exactly this order and without fused operations.
///
/// A palette holds its matrices in this form: each row computes one coordinate of a skinned vertex, and the order of
/// the operations is part of the skinning contract (see [`crate::skin`]).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)]
pub struct Affine {
    /// Three rows of a 3 x 4 matrix; the fourth column is the translation.
    pub rows: [[f32; 4]; 3],
}

impl Affine {
    /// Maps every point to itself.
    pub const IDENTITY: Self = Self {
        rows: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ],
    };

    /// Converts a column-major 4 x 4 matrix, as glTF stores it. The fourth row is ignored: it is (0, 0, 0, 1) for an
    /// affine map.
    pub fn from_cols_array(m: &[f32; 16]) -> Self {
        Self {
            rows: [
                [m[0], m[4], m[8], m[12]],
                [m[1], m[5], m[9], m[13]],
                [m[2], m[6], m[10], m[14]],
            ],
        }
    }

    /// Converts 12 numbers, column by column, as glam stores an affine map; the last three are the translation.
    fn from_columns(m: &[f32; 12]) -> Self {
        Self {
            rows: core::array::from_fn(|row| core::array::from_fn(|column| m[3 * column + row])),
        }
    }

    /// The 12 numbers, column by column, as glam stores them.
    fn to_columns(self) -> [f32; 12] {
        core::array::from_fn(|k| self.rows[k % 3][k / 3])
    }

    /// Converts a map in f64; rounds each element once.
    pub fn from_f64(map: &DAffine3) -> Self {
        let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
        let t = map.translation;
        Self {
            rows: [
                [x.x as f32, y.x as f32, z.x as f32, t.x as f32],
                [x.y as f32, y.y as f32, z.y as f32, t.y as f32],
                [x.z as f32, y.z as f32, z.z as f32, t.z as f32],
            ],
        }
    }

    /// Converts to f64; exact.
    pub fn to_f64(&self) -> DAffine3 {
        let column = |c: usize| {
            DVec3::new(
                f64::from(self.rows[0][c]),
                f64::from(self.rows[1][c]),
                f64::from(self.rows[2][c]),
            )
        };
        DAffine3 {
            matrix3: DMat3::from_cols(column(0), column(1), column(2)),
            translation: column(3),
        }
    }

    /// The image of `p`, computed in the order of operations that [`Affine`] fixes.
    #[inline]
    pub fn transform_point(&self, p: Vec3) -> Vec3 {
        let row = |m: &[f32; 4]| (m[0] * p.x + m[1] * p.y) + (m[2] * p.z + m[3]);
        Vec3::new(row(&self.rows[0]), row(&self.rows[1]), row(&self.rows[2]))
    }

    /// True if no element is infinite or NaN.
    pub fn is_finite(&self) -> bool {
        self.rows.iter().flatten().all(|x| x.is_finite())
    }

    /// True if the map mirrors: the determinant of its linear part, computed in f64, is negative.
    pub fn is_mirrored(&self) -> bool {
        self.to_f64().matrix3.determinant() < 0.0
    }

    /// An upper bound of `|A p + t|` over all `|p| <= radius`, in f64: the Frobenius norm of the linear part times
    /// `radius`, plus the length of the translation.
    pub(crate) fn reach(&self, radius: f64) -> f64 {
        let map = self.to_f64();
        let linear = map.matrix3.x_axis.length_squared()
            + map.matrix3.y_axis.length_squared()
            + map.matrix3.z_axis.length_squared();
        linear.sqrt() * radius + map.translation.length()
    }

    /// The image of `p` in f64; the reference for [`Affine::transform_point`].
    pub(crate) fn transform_point_reference(&self, p: Vec3) -> DVec3 {
        self.to_f64().transform_point3(widen(p))
    }
}

#[expect(clippy::disallowed_types, reason = "read element by element")]
impl From<Mat4> for Affine {
    /// Takes the upper three rows; the fourth is ignored.
    fn from(m: Mat4) -> Self {
        Self::from_cols_array(&m.to_cols_array())
    }
}

/// Exact, like all conversions between [`Affine`] and glam's affine maps in f32.
impl From<Affine3> for Affine {
    fn from(map: Affine3) -> Self {
        Self::from_columns(&map.to_cols_array())
    }
}

impl From<Affine> for Affine3 {
    fn from(map: Affine) -> Self {
        Self::from_cols_array(&map.to_columns())
    }
}

#[expect(clippy::disallowed_types, reason = "read element by element")]
impl From<Affine3A> for Affine {
    fn from(map: Affine3A) -> Self {
        Self::from_columns(&map.to_cols_array())
    }
}

#[expect(clippy::disallowed_types, reason = "written element by element")]
impl From<Affine> for Affine3A {
    fn from(map: Affine) -> Self {
        Self::from_cols_array(&map.to_columns())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn column_major_array_becomes_rows() {
        let mut m = [0.0; 16];
        for (i, x) in m.iter_mut().enumerate() {
            *x = i as f32;
        }
        let map = Affine::from_cols_array(&m);
        assert_eq!(map.rows[1], [1.0, 5.0, 9.0, 13.0]);
        // Row 0: 0*1 + 4*2 + 8*3 + 12; each further row adds 1*1 + 1*2 + 1*3 + 1.
        assert_eq!(
            map.transform_point(Vec3::new(1.0, 2.0, 3.0)),
            Vec3::new(44.0, 51.0, 58.0)
        );
        assert_eq!(Affine::from_f64(&map.to_f64()), map);
    }

    #[test]
    #[expect(clippy::disallowed_types, reason = "the types that are converted")]
    fn conversions_to_and_from_glam_keep_the_elements() {
        let mut map = Affine::IDENTITY;
        for (k, x) in map.rows.as_flattened_mut().iter_mut().enumerate() {
            *x = k as f32 - 3.5;
        }
        let [plain, simd] = [Affine3::from(map), Affine3::from(Affine3A::from(map))];
        for theirs in [plain, simd] {
            assert_eq!(theirs.matrix3.x_axis, Vec3::new(-3.5, 0.5, 4.5));
            assert_eq!(theirs.translation, Vec3::new(-0.5, 3.5, 7.5));
        }
        assert_eq!(Affine::from(plain), map);
        assert_eq!(Affine::from(Affine3A::from(map)), map);
        assert_eq!(Affine::from(Mat4::from(simd)), map);
    }

    #[test]
    fn a_negative_scale_is_mirrored() {
        let mut map = Affine::IDENTITY;
        assert!(!map.is_mirrored());
        map.rows[0][0] = -1.0;
        assert!(map.is_mirrored());
    }
}
