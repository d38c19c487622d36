//! A limb on one joint, and its motion.

use std::sync::Arc;

use clamber_surface::geometry::{Affine, rotation_from_axis_angle};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshError, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::skin::skin_into;
use clamber_verify::brute_force::Triangles;
use glam::{DAffine3, DQuat, DVec3, Vec3};

/// Length of the limb, metres. It lies along X, from the joint on.
pub(crate) const LENGTH: f64 = 10.0;
/// Radius of the limb, metres.
pub(crate) const RADIUS: f64 = 0.5;

/// Distance from the joint at which the limb has its stated speed, metres.
pub(crate) const AT: f64 = 8.0;

/// Number of vertices around the limb.
const SIDES: u32 = 32;
/// Number of segments along the limb.
const RINGS: u32 = 80;

/// The motion of a limb.
#[derive(Clone, Copy)]
pub(crate) enum Course {
    /// The limb turns about Z from the angle `from`, radians. At [`AT`] it moves at `speed` metres a second.
    Swing { speed: f64, from: f64 },
    /// The limb moves up and down once a second, at most at `speed` metres a second.
    Heave { speed: f64 },
}

impl Course {
    /// The joint's transform at a time, seconds.
    pub(crate) fn model_from_joint(&self, time: f64) -> DAffine3 {
        match self {
            Self::Swing { speed, from } => {
                let turn = rotation_from_axis_angle(DVec3::Z, from + speed / AT * time);
                DAffine3::from_rotation_translation(turn, DVec3::ZERO)
            }
            Self::Heave { speed } => {
                let angle = core::f64::consts::TAU * time;
                let height = speed / core::f64::consts::TAU * libm::sin(angle);
                // The limb rolls and tilts a little as it moves.
                let roll = rotation_from_axis_angle(DVec3::X, 0.1 * libm::sin(angle));
                let tilt = rotation_from_axis_angle(DVec3::Z, 0.05 * libm::cos(angle));
                let turn: DQuat = tilt * roll;
                DAffine3::from_rotation_translation(turn, DVec3::Y * height)
            }
        }
    }

    /// The palette at a time, seconds.
    pub(crate) fn palette(&self, time: f64) -> Palette {
        Palette::from_matrices([Affine::from_f64(&self.model_from_joint(time))])
    }
}

/// The limb: a closed tube.
pub(crate) fn limb() -> Result<Arc<ColliderMesh>, MeshError> {
    let mut positions = Vec::new();
    for ring in 0..=RINGS {
        let x = LENGTH * f64::from(ring) / f64::from(RINGS);
        for side in 0..SIDES {
            let angle = core::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
            let (y, z) = (RADIUS * libm::cos(angle), RADIUS * libm::sin(angle));
            positions.push(DVec3::new(x, y, z).as_vec3());
        }
    }
    let (first, last) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([Vec3::ZERO, Vec3::X * LENGTH as f32]);
    let mut triangles = Vec::new();
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        for ring in 0..RINGS {
            let (a, b) = (ring * SIDES + side, ring * SIDES + next);
            triangles.push([a, b, a + SIDES]);
            triangles.push([b, b + SIDES, a + SIDES]);
        }
        let end = RINGS * SIDES;
        triangles.push([first, next, side]);
        triangles.push([last, end + side, end + next]);
    }
    let source = MeshSource::rigid(&positions, &triangles);
    Ok(Arc::new(
        ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0,
    ))
}

/// Distance of a point from the skin, in f64 over all triangles; negative inside.
pub(crate) fn signed_distance(mesh: &ColliderMesh, palette: &Palette, point: DVec3) -> f64 {
    let mut positions = Vec::new();
    // Palette and mesh both have one joint, so this cannot fail.
    let _ = skin_into(mesh, palette.matrices(), &mut positions);
    let triangles = mesh.triangles().iter();
    let triangles = triangles.map(|t| t.map(|v| positions[v.index()].as_dvec3()));
    let distance = Triangles(triangles.collect()).distance(point);
    if clamber_scenes::solid_angle::is_inside(&positions, mesh, point) {
        -distance
    } else {
        distance
    }
}
