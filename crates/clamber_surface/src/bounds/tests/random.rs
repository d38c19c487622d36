//! Random creatures and palettes, as unlike a real limb as the contract allows.

use glam::{DAffine3, DMat3, Vec3};

use crate::geometry::{Affine, MAX_COORDINATE, rotation_from_axis_angle, widen};
use crate::mesh::{ColliderMesh, VertexId};
use crate::rig::Palette;
use crate::testing::{direction, influence, point, separate, skinned_mesh};

/// Number of joints of a test creature.
pub(crate) const JOINTS: u32 = 20;

/// Number of vertices of a test creature's patch.
const VERTICES: usize = 60;

/// How the weights of a test creature are distributed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spread {
    Random,
    /// All near their mean, as in the middle of a limb.
    NearlyEqual,
    /// From 1 down to about 1e-9, which rounds to zero, on joints in any order.
    Uneven,
    /// A vertex follows a few of the node's many joints.
    Few,
    /// The same weights at every vertex.
    Constant,
}

impl Spread {
    pub(crate) const ALL: [Self; 5] = [
        Self::Random,
        Self::NearlyEqual,
        Self::Uneven,
        Self::Few,
        Self::Constant,
    ];
}

fn weight(rng: &mut fastrand::Rng, spread: Spread, k: usize) -> f32 {
    match spread {
        Spread::Random => rng.f32(),
        Spread::NearlyEqual => 1.0 + 1e-3 * rng.f32(),
        Spread::Uneven => libm::powf(10.0, -9.0 * rng.f32()),
        Spread::Few => rng.f32() * [0.0, 1.0][usize::from(rng.u32(0..4) == 0 || k == 0)],
        Spread::Constant => 1.0 + k as f32,
    }
}

/// A patch of vertices on an ellipsoid, which may be as small as a point, with `influences` joints each. One
/// triangle lies beside it, since the patch may have no area.
pub(crate) fn creature(
    rng: &mut fastrand::Rng,
    influences: usize,
    spread: Spread,
) -> (ColliderMesh, Vec<VertexId>) {
    let size = [1e-3, 1.0, 1e3][rng.usize(0..3)];
    let offset = direction(rng) * [0.0, 1.0, 1e3][rng.usize(0..3)];
    // A part of a creature is often thin, or small beside its distance from the origin.
    let stretch = Vec3::new(1.0, rng.f32(), rng.f32()) * size * [1e-3, 1.0][rng.usize(0..2)];
    let mut positions: Vec<Vec3> = (0..VERTICES)
        .map(|_| direction(rng) * stretch + offset)
        .collect();
    positions.extend([Vec3::ONE, Vec3::X, Vec3::Y].map(|p| (p + Vec3::ONE) * size + offset));
    let first = rng.u32(0..JOINTS);
    let mut given = Vec::new();
    for _ in 0..positions.len() {
        for k in 0..influences {
            let joint = (first + k as u32) % JOINTS;
            given.push(influence(joint, weight(rng, spread, k)));
        }
    }
    let mesh = skinned_mesh(&positions, &separate(21), &given, JOINTS as usize);
    let patch = (0..mesh.positions().len() as u32 - 3).map(VertexId);
    let patch = patch.collect();
    (mesh, patch)
}

/// Kinds of random palettes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Motion {
    /// The whole creature moves rigidly.
    Rigid,
    /// Each joint is turned a little, as in a limb.
    Bent,
    Rotations,
    NonUniform,
    Mirrored,
    /// Arbitrary elements.
    Sheared,
    Tiny,
    Subnormal,
    /// As large as a surface accepts.
    Huge,
    /// Some matrices are zero.
    Zeros,
}

/// All kinds. A test in `bounds/root.rs` uses the first six, so the order matters.
pub(crate) const MOTIONS: [Motion; 10] = [
    Motion::Rigid,
    Motion::Bent,
    Motion::Rotations,
    Motion::NonUniform,
    Motion::Mirrored,
    Motion::Sheared,
    Motion::Tiny,
    Motion::Subnormal,
    Motion::Huge,
    Motion::Zeros,
];

fn rotation(rng: &mut fastrand::Rng, angle: f64) -> DAffine3 {
    let axis = widen(direction(rng));
    DAffine3::from_quat(rotation_from_axis_angle(
        axis.normalize(),
        angle * rng.f64(),
    ))
}

fn matrix(rng: &mut fastrand::Rng, motion: Motion, radius: f32) -> DAffine3 {
    let shift = DAffine3::from_translation(widen(point(rng, radius)));
    let diagonal = |scale: Vec3| DAffine3::from_mat3(DMat3::from_diagonal(widen(scale)));
    let scale = Vec3::new(rng.f32(), rng.f32(), rng.f32()) * 4.0;
    let linear = match motion {
        Motion::Rigid | Motion::Bent => rotation(rng, 0.3),
        Motion::Rotations => rotation(rng, 6.3),
        Motion::NonUniform => rotation(rng, 6.3) * diagonal(scale) * rotation(rng, 6.3),
        Motion::Mirrored => rotation(rng, 6.3) * diagonal(Vec3::new(-1.0, 1.0, 1.0)),
        _ => {
            let mut column = || widen(point(rng, 2.0));
            DAffine3::from_mat3(DMat3::from_cols(column(), column(), column()))
        }
    };
    let map = shift * linear;
    let scaled = |factor: f64| DAffine3 {
        matrix3: map.matrix3 * factor,
        translation: map.translation * factor,
    };
    match motion {
        Motion::Tiny => scaled(1e-20),
        Motion::Subnormal => scaled(1e-43),
        Motion::Huge => {
            scaled(MAX_COORDINATE * 0.999 / Affine::from_f64(&map).reach(f64::from(radius)))
        }
        Motion::Zeros if rng.bool() => scaled(0.0),
        _ => map,
    }
}

pub(crate) fn palette(rng: &mut fastrand::Rng, motion: Motion, radius: f32) -> Palette {
    let one = matrix(rng, motion, radius);
    let matrices = (0..JOINTS).map(|_| match motion {
        Motion::Rigid => one,
        Motion::Bent => one * rotation(rng, 0.3),
        _ => matrix(rng, motion, radius),
    });
    Palette::from_matrices(matrices.map(|m| Affine::from_f64(&m)))
}
