use glam::{DAffine3, DMat3};

use crate::geometry::{Affine, MAX_COORDINATE};
use crate::mesh::ColliderMesh;
use crate::rig::{JointId, Palette};
use crate::surface::SurfaceError;

/// What bounds read of a palette: every matrix in f64, and how much it stretches and moves at most.
/// Computed once a palette, for all nodes.
#[derive(Clone, Debug, Default)]
pub struct JointMaps {
    maps: Vec<JointMap>,
}

/// One joint's matrix.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointMap {
    pub(super) model_from_mesh: DAffine3,
    /// At least the largest singular value of the linear part.
    pub(super) stretch: f64,
    /// Length of the translation.
    pub(super) shift: f64,
}

/// The bound of the singular value is computed with a relative error below this: some 90 roundings
/// of 2^-53, of which the eighth root leaves an eighth.
const STRETCH_SLACK: f64 = 1e-14;

/// The exponent's bits of an f64: they alone are the power of two below a number.
const EXPONENT: u64 = 0x7ff << 52;

/// Less the bits of a power of two, those of its inverse.
const INVERSE: u64 = 2046 << 52;

impl JointMaps {
    /// Reads a palette for the nodes of `mesh`.
    ///
    /// # Errors
    /// [`SurfaceError::JointCount`], or [`SurfaceError::Palette`] for a matrix that is not finite or
    /// moves vertices beyond 2^100: the palettes that [`crate::surface::SkinnedSurface`] refuses.
    pub fn new(mesh: &ColliderMesh, palette: &Palette) -> Result<Self, SurfaceError> {
        let mut maps = Self::default();
        maps.update(mesh, palette)?;
        Ok(maps)
    }

    /// [`JointMaps::new`] in place: keeps its memory.
    ///
    /// # Errors
    /// As [`JointMaps::new`]; nothing is changed then.
    pub fn update(&mut self, mesh: &ColliderMesh, palette: &Palette) -> Result<(), SurfaceError> {
        let matrices = palette.matrices();
        if matrices.len() != mesh.joint_count() {
            return Err(SurfaceError::JointCount {
                expected: mesh.joint_count(),
                found: matrices.len(),
            });
        }
        let radius = f64::from(mesh.radius());
        // Written so that NaN is refused.
        let keeps = |matrix: &Affine| matrix.reach(radius) <= MAX_COORDINATE;
        if let Some(joint) = matrices.iter().position(|matrix| !keeps(matrix)) {
            return Err(SurfaceError::Palette(JointId(joint as u32)));
        }
        self.maps.clear();
        self.maps.extend(matrices.iter().map(JointMap::new));
        Ok(())
    }

    /// The most by which a joint's matrix lengthens any vector: at least its largest singular
    /// value, at most 1.04 times it. `None` for a joint out of range.
    pub fn stretch(&self, joint: JointId) -> Option<f64> {
        self.maps.get(joint.0 as usize).map(|map| map.stretch)
    }

    pub(super) fn of(&self, joint: JointId) -> &JointMap {
        &self.maps[joint.0 as usize]
    }
}

impl JointMap {
    fn new(matrix: &Affine) -> Self {
        let model_from_mesh = matrix.to_f64();
        Self {
            model_from_mesh,
            stretch: stretch_bound(&model_from_mesh.matrix3),
            shift: model_from_mesh.translation.length(),
        }
    }
}

/// `(norm_inf((A^T A)^4))^(1/8)`, rounded up: at least the largest singular value of A, and at most
/// `((1 + sqrt(3)) / 2)^(1/8)`, 1.04, times it. Exact but for rounding where A is a rotation times a
/// uniform scale.
///
/// The largest eigenvalue of `A^T A` is that singular value's square, and any induced norm is at
/// least the largest eigenvalue. A is scaled to elements below 2 first, by a power of two, which is
/// exact, so that no eighth power overflows, and none that counts underflows.
fn stretch_bound(linear: &DMat3) -> f64 {
    StretchPower::new(linear).root()
}

/// What [`stretch_bound`] computes before its roots: they take as long as the rest, and that of many
/// joints runs at a time where it stands apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct StretchPower {
    /// A power of two, or the bound itself where it is 0 or not finite.
    scale: f64,
    /// `norm_inf((A^T A)^4)` for A divided by `scale`.
    norm: f64,
}

impl StretchPower {
    pub(super) fn new(linear: &DMat3) -> Self {
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
        let [x, y, z] = columns.map(|c| c.abs());
        // Not `f64::max`: to keep NaN out costs it more than the rest of this function.
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

    pub(super) fn root(self) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{direction, point};
    use glam::DVec3;

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
                assert_eq!(stretch_bound(&linear), 0.0);
                continue;
            }
            let exact = stretch_reference(&linear, direction(&mut rng).as_dvec3());
            let bound = stretch_bound(&linear);
            assert!(
                bound >= exact * (1.0 - 1e-15),
                "{linear}: {bound} < {exact}"
            );
            assert!(bound <= exact * 1.0399, "{linear}: {bound} against {exact}");
        }
    }

    #[test]
    fn a_uniform_scale_is_met_exactly() {
        for scale in [1e-45f32, 1e-20, 1.0, 3.0, 1e30] {
            let scale = f64::from(scale);
            let bound = stretch_bound(&DMat3::from_diagonal(DVec3::splat(-scale)));
            assert!(
                bound >= scale && bound <= scale * (1.0 + 3e-14),
                "{scale}: {bound}"
            );
        }
    }
}
