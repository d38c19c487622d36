//! Palettes, and places in the world, made from bytes.

use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::rig::Palette;
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

use super::bytes::Bytes;

/// 2^40: all numbers of a tame pose and all coordinates of a tame mesh are below it. No result computed from them comes
/// near 2^100, the limit of coordinates.
const TAME: f32 = (1u64 << 40) as f32;

/// A palette for `joints` joints of a mesh with the given radius. With `faults` it is sometimes a palette that must be
/// rejected.
pub(crate) fn palette(bytes: &mut Bytes<'_>, joints: usize, radius: f32, faults: bool) -> Palette {
    let kind = bytes.byte() % 16;
    let unit = radius.clamp(f32::MIN_POSITIVE, TAME);
    let mut matrices: Vec<Affine> = Vec::with_capacity(joints);
    for joint in 0..joints {
        let mut one = match kind {
            // All joints have the same matrix.
            0 | 1 if joint > 0 => matrices[0],
            _ => matrix(bytes, kind, unit),
        };
        if faults && bytes.one_in(128) {
            one.rows[bytes.below(3)][bytes.below(4)] = bytes.hostile();
        }
        matrices.push(one);
    }
    if faults && bytes.one_in(32) {
        matrices.pop();
    }
    if faults && bytes.one_in(32) {
        matrices.push(Affine::IDENTITY);
    }
    Palette::from_matrices(matrices)
}

fn matrix(bytes: &mut Bytes<'_>, kind: u8, unit: f32) -> Affine {
    let shift = bytes.point().clamp(Vec3::splat(-9.0), Vec3::splat(9.0)) * unit * 0.1;
    let angle = f64::from(bytes.share()) * if kind < 6 { 0.5 } else { 6.3 };
    let turn = DMat3::from_quat(rotation(bytes, angle));
    let diagonal = |x: f64, y: f64, z: f64| turn * DMat3::from_diagonal(DVec3::new(x, y, z));
    let linear = match kind {
        0..=7 => turn,
        8 => diagonal(-1.0, 1.0, 1.0),
        9 => diagonal(
            f64::from(bytes.share()) * 4.0,
            f64::from(bytes.share()),
            1.0,
        ),
        // Singular matrices: onto a plane or a line (10), to a point (11).
        10 => diagonal(1.0, bytes.pick(&[0.0, 1.0]), 0.0),
        11 => DMat3::ZERO,
        12 => turn * 1e-43,
        13 => turn * 1e20,
        _ => {
            let mut axis = || bytes.point().as_dvec3();
            DMat3::from_cols(axis(), axis(), axis())
        }
    };
    let map = DAffine3 {
        matrix3: linear,
        translation: shift.as_dvec3(),
    };
    let mut one = Affine::from_f64(&map);
    if kind == 13 || kind == 15 {
        one.rows[bytes.below(3)][3] = bytes.number();
    }
    one
}

fn rotation(bytes: &mut Bytes<'_>, angle: f64) -> DQuat {
    let axis = bytes.point().as_dvec3().try_normalize();
    axis.map_or(DQuat::IDENTITY, |axis| {
        rotation_from_axis_angle(axis, angle)
    })
}

/// A creature's place in the world. With `faults` it is sometimes invalid.
pub(crate) fn similarity(bytes: &mut Bytes<'_>, faults: bool) -> Similarity {
    if bytes.one_in(3) {
        return Similarity::IDENTITY;
    }
    let angle = f64::from(bytes.share()) * 6.3;
    let mut place = Similarity {
        rotation: rotation(bytes, angle),
        scale: bytes.pick(&[1.0, 1.0, 0.5, 3.0]),
        translation: bytes.point().as_dvec3() * bytes.pick(&[1.0, 1e5]),
    };
    if faults && bytes.one_in(8) {
        let number = f64::from(bytes.hostile());
        match bytes.below(4) {
            0 => place.scale = number,
            1 => place.scale = bytes.pick(&[f64::MIN_POSITIVE, 1e-320, f64::MAX, 1e-30, 1e30]),
            2 => place.translation.y = bytes.pick(&[number, f64::MAX]),
            _ => place.rotation.x += number,
        }
    }
    place
}

/// True for a palette and a place that any surface of a tame mesh must accept.
pub(crate) fn is_tame(palette: &Palette, place: &Similarity, radius: f32) -> bool {
    let elements = palette.matrices().iter().flat_map(|m| m.rows);
    elements.flatten().all(|x| x.abs() < TAME) && radius < TAME && is_tame_place(place)
}

fn is_tame_place(place: &Similarity) -> bool {
    let far = place.translation.abs().max_element();
    let turn = (place.rotation.length() - 1.0).abs();
    // `max_element` ignores NaN, so finiteness is tested separately.
    let finite = place.translation.is_finite();
    finite && (0.1..10.0).contains(&place.scale) && far < f64::from(TAME) && turn < 1e-6
}

/// True for a palette or a place that every surface must reject.
pub(crate) fn is_absurd(palette: &Palette, place: &Similarity) -> bool {
    let usable = place.translation.is_finite() && place.rotation.is_finite() && place.scale > 0.0;
    !usable || !place.scale.is_finite() || !palette.matrices().iter().all(Affine::is_finite)
}
