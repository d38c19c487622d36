//! The fuzz target of poses: any palette at any place is either rejected without a change, or gives finite positions,
//! exactly as the skinning contract defines them.

use std::sync::Arc;

use clamber_surface::SimdLevel;
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderMesh, TriangleId, VertexId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{Diagnostics, Motion, SkinnedSurface};
use glam::Vec3;

use super::bits::bits;
use super::bytes::Bytes;
use super::mesh::built;
use super::poses::{is_absurd, is_tame, palette, similarity};

/// Numbers of checked poses and motions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Palettes {
    /// Poses that were accepted.
    pub accepted: usize,
    /// Poses that were rejected.
    pub refused: usize,
    /// Motions of anchors that were checked.
    pub motions: usize,
}

/// Poses a mesh made from any bytes with palettes made from any bytes.
///
/// # Panics
/// If a check fails.
pub fn palettes(data: &[u8]) -> Palettes {
    let mut bytes = Bytes::new(data);
    let mut seen = Palettes::default();
    let Some(mesh) = built(&mut bytes) else {
        return seen;
    };
    let (mesh, level) = (Arc::new(mesh), bytes.pick(&SimdLevel::available()));
    let mut surface = SkinnedSurface::with_simd_level(mesh.clone(), level);
    let rest = Palette::from_matrices(vec![Affine::IDENTITY; mesh.joint_count()]);
    let mut taken = (rest, Similarity::IDENTITY);
    for _ in 0..6 {
        let radius = mesh.radius();
        let palette = palette(&mut bytes, mesh.joint_count(), radius, true);
        let place = similarity(&mut bytes, true);
        let before = State::of(&surface);
        let jump = bytes.one_in(4);
        let result = if jump {
            surface.teleport(&palette, place)
        } else {
            surface.advance(&palette, place)
        };
        let case = || format!("jump {jump}, {palette:?}, {place:?}");
        if let Err(error) = result {
            assert!(!error.to_string().is_empty());
            assert!(before == State::of(&surface), "{error}: {}", case());
            let fits = palette.matrices().len() == mesh.joint_count();
            let tame = |(p, s): (&Palette, &Similarity)| is_tame(p, s, radius);
            let must = fits && tame((&palette, &place)) && tame((&taken.0, &taken.1));
            assert!(!must, "{error}: {}", case());
            seen.refused += 1;
            continue;
        }
        assert!(!is_absurd(&palette, &place), "accepted: {}", case());
        let previous = previous_palette(&surface, jump, &palette, &taken);
        check_positions(&surface, &palette, &previous);
        taken = (palette, *surface.world_from_model());
        seen.accepted += 1;
        seen.motions += check_motions(&surface, &mut bytes);
    }
    seen
}

/// The state of a surface that a rejected pose must not change.
#[derive(PartialEq)]
struct State {
    current: Vec<[u32; 3]>,
    previous: Vec<[u32; 3]>,
    world_from_model: Similarity,
    diagnostics: Diagnostics,
}

impl State {
    fn of(surface: &SkinnedSurface) -> Self {
        let all = || (0..surface.mesh().positions().len() as u32).map(VertexId);
        let space = surface.in_model();
        let current = all().filter_map(|v| space.position(v));
        let previous = all().filter_map(|v| space.previous_position(v));
        Self {
            current: current.map(bits).collect(),
            previous: previous.map(bits).collect(),
            world_from_model: *surface.world_from_model(),
            diagnostics: surface.diagnostics(),
        }
    }
}

/// The matrices of the previous positions: the last pose's matrices, in the current model frame; after a jump, the
/// current matrices.
fn previous_palette(
    surface: &SkinnedSurface,
    jump: bool,
    palette: &Palette,
    taken: &(Palette, Similarity),
) -> Vec<Affine> {
    let now = surface.world_from_model();
    if jump {
        return palette.matrices().to_vec();
    }
    let last = taken.0.matrices();
    if *now == taken.1 {
        return last.to_vec();
    }
    let now_from_before = now.relative(&taken.1);
    let moved = |m: &Affine| Affine::from_f64(&(now_from_before * m.to_f64()));
    last.iter().map(moved).collect()
}

/// Checks the position of every vertex, from each query for positions, against the skinning contract.
fn check_positions(surface: &SkinnedSurface, palette: &Palette, previous: &[Affine]) {
    let (mesh, space) = (surface.mesh(), surface.in_model());
    let mut all = Vec::new();
    surface.skin_all(&mut all);
    assert_eq!(all.len(), mesh.positions().len());
    for (index, found) in all.into_iter().enumerate() {
        let v = VertexId(index as u32);
        let wanted = skinned(mesh, palette.matrices(), v);
        assert!(wanted.is_finite(), "vertex {v}: {wanted}");
        assert_eq!(
            bits(found),
            bits(wanted),
            "vertex {v}, all: {found} {wanted}"
        );
        let found = space.position(v).map(bits);
        assert_eq!(found, Some(bits(wanted)), "vertex {v}: {wanted}");
        let wanted = skinned(mesh, previous, v);
        assert!(wanted.is_finite(), "vertex {v}, before: {wanted}");
        let found = space.previous_position(v).map(bits);
        assert_eq!(found, Some(bits(wanted)), "vertex {v}, before: {wanted}");
    }
    let beyond = VertexId(mesh.positions().len() as u32);
    assert_eq!(space.position(beyond), None);
    assert_eq!(space.previous_position(beyond), None);
}

/// The skinning contract, written out.
fn skinned(mesh: &ColliderMesh, palette: &[Affine], v: VertexId) -> Vec3 {
    let p = mesh.positions()[v.index()];
    mesh.influences(v).fold(Vec3::ZERO, |sum, (joint, weight)| {
        sum + palette[joint.0 as usize].transform_point(p) * weight
    })
}

/// Checks the motions of some anchors; returns the number of motions.
fn check_motions(surface: &SkinnedSurface, bytes: &mut Bytes<'_>) -> usize {
    let triangles = surface.mesh().triangles().len();
    let mut moved = 0;
    for _ in 0..3 {
        let triangle = TriangleId(bytes.below(triangles + 1) as u32);
        let (u, v) = (bytes.share(), bytes.share());
        let (u, v) = if u + v > 1.0 {
            (1.0 - u, 1.0 - v)
        } else {
            (u, v)
        };
        let mut barycentric = [u, v, 1.0 - u - v];
        if bytes.one_in(16) {
            barycentric[bytes.below(3)] = bytes.hostile();
        }
        let Ok(anchor) = surface.anchor(triangle, barycentric) else {
            continue;
        };
        let length = anchor.frame.as_dquat().length();
        assert!((length - 1.0).abs() < 1e-5, "{anchor:?}");
        let dt = bytes.pick(&[
            1.0 / 60.0,
            1.0 / 60.0,
            1.0,
            1e-12,
            1e300,
            0.0,
            -1.0,
            f64::NAN,
        ]);
        match surface.in_model().motion(&anchor, dt) {
            Ok(motion) => {
                check_motion(&motion);
                moved += 1;
            }
            Err(error) => assert!(dt <= 1e-12 || dt.is_nan(), "{dt}: {error}"),
        }
    }
    moved
}

fn check_motion(motion: &Motion) {
    let unit = |length: f64| (length - 1.0).abs() < 1e-5;
    assert!(motion.position.is_finite(), "{motion:?}");
    assert!(motion.previous_position.is_finite(), "{motion:?}");
    assert!(motion.velocity.is_finite(), "{motion:?}");
    assert!(motion.angular_velocity.is_finite(), "{motion:?}");
    assert!(unit(motion.frame.as_dquat().length()), "{motion:?}");
    assert!(unit(motion.normal.as_dvec3().length()), "{motion:?}");
    // The ratio of two areas. One area may be 2^200 times the other, so the ratio may be infinite, but never NaN.
    assert!(motion.area_ratio >= 0.0, "{motion:?}");
    let [larger, smaller] = motion.stretches;
    assert!(smaller >= 0.0 && larger >= smaller, "{motion:?}");
}
