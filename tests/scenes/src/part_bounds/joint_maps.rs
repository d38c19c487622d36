use clamber_surface::rig::{JointId, Palette};
use glam::{DAffine3, DMat3};

/// A palette as the bounds read it: every matrix in f64, its largest stretch, and the length of its translation.
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

impl JointMaps {
    /// Reads a palette. Reuses the memory of the last one.
    pub fn update(&mut self, palette: &Palette) {
        self.maps.clear();
        let matrices = palette.matrices().iter().map(|matrix| matrix.to_f64());
        self.maps.extend(matrices.map(|model_from_mesh| JointMap {
            model_from_mesh,
            stretch: stretch_bound(&model_from_mesh.matrix3),
            shift: model_from_mesh.translation.length(),
        }));
    }

    pub(super) fn of(&self, joint: JointId) -> &JointMap {
        &self.maps[joint.index()]
    }
}

/// `(norm_inf((A^T A)^4))^(1/8)`, rounded up: at least the largest singular value, and at most 1.04 times it.
///
/// Holds while the eighth powers neither overflow nor underflow, as they do not for a creature's matrices.
fn stretch_bound(linear: &DMat3) -> f64 {
    let squared = linear.transpose() * *linear;
    let fourth = squared * squared;
    let eighth = fourth * fourth;
    let rows = eighth.transpose();
    let sums = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.abs().element_sum());
    let norm = sums.into_iter().fold(0.0, f64::max);
    norm.sqrt().sqrt().sqrt() * (1.0 + 1e-13)
}
