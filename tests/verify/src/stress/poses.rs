//! Palettes of every family of poses.

use core::ops::Range;

use clamber_surface::geometry::{Affine, rotation_from_axis_angle};
use clamber_surface::rig::Palette;
use glam::{DAffine3, DMat3, DVec3};

use super::soups::{random_direction, random_turn};
use super::{PoseFamily, Subject};

/// The motion of a creature's joints from tick to tick.
pub(super) struct Motion {
    family: PoseFamily,
    /// For each joint the axis of its rotation, and the largest angle, radians.
    axes: Vec<(DVec3, f64)>,
    /// The joints that the family deforms.
    chosen: Range<usize>,
    /// The linear map of the chosen joints, applied before their rotation.
    deformation: DMat3,
    /// Scale of each joint in [`PoseFamily::Scaled`].
    factors: Vec<f64>,
}

impl Motion {
    pub(super) fn new(subject: &Subject, family: PoseFamily, rng: &mut fastrand::Rng) -> Self {
        let joints = subject.origins.len();
        // Keeps the total turn of a chain about the same for any number of joints.
        let most = 4.0 / (joints as f64).max(4.0);
        let axes = (0..joints).map(|_| (random_direction(rng), most * rng.f64()));
        let axes = axes.collect();
        let first = rng.usize(0..joints);
        let all = matches!(family, PoseFamily::Mirrored | PoseFamily::Flat) && rng.bool();
        let chosen = if all || joints == 1 {
            0..joints
        } else {
            first..rng.usize(first + 1..=joints)
        };
        let turn = DMat3::from_quat(random_turn(rng));
        let diagonal = |x, y, z| turn * DMat3::from_diagonal(DVec3::new(x, y, z));
        let deformation = match family {
            PoseFamily::Mirrored => diagonal(-1.0, 1.0, 1.0),
            PoseFamily::InsideOut => -DMat3::IDENTITY,
            PoseFamily::Flat => diagonal(1.0, [0.0, 1.0][rng.usize(0..2)], 0.0),
            PoseFamily::Denormal => turn * [1e-39, 1e-42, 1e-45][rng.usize(0..3)],
            _ => DMat3::IDENTITY,
        };
        let factors = (0..joints).map(|_| libm::exp10(8.0 * rng.f64() - 4.0));
        Self {
            family,
            axes,
            chosen,
            deformation,
            factors: factors.collect(),
        }
    }

    /// The palette of a tick.
    pub(super) fn palette(
        &self,
        subject: &Subject,
        tick: usize,
        rng: &mut fastrand::Rng,
    ) -> Palette {
        if self.family == PoseFamily::Rest {
            return Palette::from_matrices(vec![Affine::IDENTITY; subject.origins.len()]);
        }
        let swing = libm::sin(0.7 * tick as f64 + 0.3);
        let mut matrices: Vec<Affine> = Vec::with_capacity(subject.origins.len());
        let (mut parent, mut hinge) = (DAffine3::IDENTITY, DVec3::ZERO);
        let mut pit = None;
        for (joint, origin) in subject.origins.iter().enumerate() {
            let (axis, most) = self.axes[joint];
            let local = DAffine3::from_rotation_translation(
                rotation_from_axis_angle(axis, most * swing),
                *origin - hinge,
            );
            let mut posed = parent * local;
            if subject.is_chain {
                (parent, hinge) = (posed, *origin);
            }
            if self.family == PoseFamily::Flung && rng.u32(0..3) == 0 {
                let way = random_direction(rng) * (30.0 * rng.f64() * subject.extent);
                posed.translation += way;
            }
            if self.chosen.contains(&joint) {
                match self.family {
                    PoseFamily::Collapsed => {
                        posed.translation = *pit.get_or_insert(posed.translation);
                        posed.matrix3 = DMat3::ZERO;
                    }
                    PoseFamily::Scaled if joint % 2 == self.chosen.start % 2 => {
                        posed.matrix3 *= self.factors[joint];
                    }
                    PoseFamily::Scaled => {}
                    _ => posed.matrix3 *= self.deformation,
                }
            }
            let matrix = posed * DAffine3::from_translation(-*origin);
            matrices.push(Affine::from_f64(&matrix));
        }
        if self.family == PoseFamily::Denormal {
            for matrix in &mut matrices[self.chosen.clone()] {
                let tiny = f32::from_bits(rng.u32(1..1 << 23));
                matrix.rows[rng.usize(0..3)][rng.usize(0..4)] = tiny;
            }
        }
        Palette::from_matrices(matrices)
    }
}

/// Matrix elements that make a palette invalid.
const FAULTS: [f32; 6] = [
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    // 2^101, where 2^100 is the limit.
    2.535_301_2e30,
    -3e38,
];

/// A palette with a fault, and the joint that has it.
pub(super) fn spoilt(palette: &Palette, rng: &mut fastrand::Rng) -> (Palette, usize) {
    let mut matrices = palette.matrices().to_vec();
    let joint = rng.usize(0..matrices.len());
    // The fault is in the translation: there it counts in full, however small the mesh is.
    let element = &mut matrices[joint].rows[rng.usize(0..3)][3];
    *element = FAULTS[rng.usize(0..FAULTS.len())];
    (Palette::from_matrices(matrices), joint)
}
