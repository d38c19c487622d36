//! Helpers that the unit tests share: a closed tube on a chain of joints, and palettes that bend or move it.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3};

use crate::geometry::{Affine, Capsule, rotation_from_axis_angle};
use crate::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
use crate::rig::{JointId, Palette};

/// The number of cases of a randomised test to run: all if the variable `CLAMBER_ALL_CASES` is set, as
/// `cargo xtask nightly` does, else the first fifth.
pub(crate) fn cases(all: usize) -> usize {
    match std::env::var_os("CLAMBER_ALL_CASES") {
        Some(_) => all,
        None => all.div_ceil(5),
    }
}

/// A closed tube of radius 0.5 along X from 0 to `joints - 1`, one joint per metre. Each vertex follows the two
/// nearest joints.
pub(crate) fn tube(joints: u32, sides: u32) -> Arc<ColliderMesh> {
    let rings = (joints - 1) * 4 + 1;
    let mut positions = Vec::new();
    let mut influences = Vec::new();
    let mut push = |x: f32, y: f32, z: f32| {
        positions.push(Vec3::new(x, y, z));
        let joint = (x.floor() as u32).min(joints - 2);
        let weight = x - joint as f32;
        influences.push(Influence {
            joint: JointId(joint),
            weight: 1.0 - weight,
        });
        influences.push(Influence {
            joint: JointId(joint + 1),
            weight,
        });
    };
    for ring in 0..rings {
        for side in 0..sides {
            let angle = side as f32 / sides as f32 * core::f32::consts::TAU;
            let (y, z) = (libm::cosf(angle) * 0.5, libm::sinf(angle) * 0.5);
            push(ring as f32 / 4.0, y, z);
        }
    }
    push(0.0, 0.0, 0.0);
    push((joints - 1) as f32, 0.0, 0.0);
    let (first, last) = (rings * sides, rings * sides + 1);
    let mut triangles = Vec::new();
    for side in 0..sides {
        let next = (side + 1) % sides;
        for ring in 0..rings - 1 {
            let (a, b) = (ring * sides + side, ring * sides + next);
            triangles.push([a, b, a + sides]);
            triangles.push([b, b + sides, a + sides]);
        }
        let end = (rings - 1) * sides;
        triangles.push([first, next, side]);
        triangles.push([last, end + side, end + next]);
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: joints as usize,
        ..MeshSource::default()
    };
    let (mesh, report) = ColliderMesh::build(&source, &BuildOptions::default()).unwrap();
    assert_eq!(report.degenerate_triangles + report.duplicate_triangles, 0);
    Arc::new(mesh)
}

/// The palette that bends the tube by `angle` radians about `axis` at every joint except the first.
pub(crate) fn bend(joints: u32, axis: DVec3, angle: f64) -> Palette {
    let mut global = DAffine3::IDENTITY;
    let turn = DAffine3::from_quat(rotation_from_axis_angle(axis, angle));
    let mut matrices = Vec::new();
    for joint in 0..joints {
        if joint > 0 {
            global = global * DAffine3::from_translation(DVec3::X) * turn;
        }
        let bind = DAffine3::from_translation(DVec3::X * -f64::from(joint));
        matrices.push(Affine::from_f64(&(global * bind)));
    }
    Palette::from_matrices(matrices)
}

/// The palette that moves the whole tube rigidly.
pub(crate) fn rigid(joints: u32, rotation: DQuat, translation: DVec3) -> Palette {
    let map = DAffine3::from_rotation_translation(rotation, translation);
    Palette::from_matrices((0..joints).map(|_| Affine::from_f64(&map)))
}

/// A random unit vector from a seeded generator.
pub(crate) fn direction(rng: &mut fastrand::Rng) -> Vec3 {
    loop {
        let v = point(rng, 1.0);
        if v.length() > 0.1 && v.length() <= 1.0 {
            return v.normalize();
        }
    }
}

/// A random point from a seeded generator, in the cube from `-size` to `size` along each axis.
pub(crate) fn point(rng: &mut fastrand::Rng, size: f32) -> Vec3 {
    let mut coordinate = || (rng.f32() * 2.0 - 1.0) * size;
    Vec3::new(coordinate(), coordinate(), coordinate())
}

/// [`Capsule::ball`] for arguments that are known to be valid.
pub(crate) fn ball(center: Vec3, radius: f32) -> Capsule {
    Capsule::ball(center, radius).unwrap()
}

/// [`Capsule::new`] for arguments that are known to be valid.
pub(crate) fn capsule(a: Vec3, b: Vec3, radius: f32) -> Capsule {
    Capsule::new(a, b, radius).unwrap()
}
