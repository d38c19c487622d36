//! Helpers that the unit tests share: meshes, palettes that bend or move a tube, and shapes.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec3};

use crate::geometry::{Affine, Capsule, Similarity, rotation_from_axis_angle};
use crate::mesh::hierarchy::{Child, Hierarchy};
use crate::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use crate::rig::{JointId, Palette};
use crate::surface::SkinnedSurface;

/// The number of cases of a randomised test to run: all if the variable `CLAMBER_ALL_CASES` is set, as
/// `cargo xtask nightly` does, else the first fifth.
pub(crate) fn cases(all: usize) -> usize {
    match std::env::var_os("CLAMBER_ALL_CASES") {
        Some(_) => all,
        None => all.div_ceil(5),
    }
}

pub(crate) fn influence(joint: u32, weight: f32) -> Influence {
    Influence {
        joint: JointId(joint),
        weight,
    }
}

/// The mesh that a build with the default options makes.
pub(crate) fn built(source: &MeshSource<'_>) -> ColliderMesh {
    ColliderMesh::build(source, &ColliderBuildOptions::default())
        .unwrap()
        .0
}

/// A mesh whose vertices have equally many influences each.
pub(crate) fn skinned_mesh(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    influences: &[Influence],
    joint_count: usize,
) -> ColliderMesh {
    built(&MeshSource {
        positions,
        triangles,
        influences,
        joint_count,
        ..MeshSource::default()
    })
}

/// `count` triangles that share no vertices.
pub(crate) fn separate(count: u32) -> Vec<[u32; 3]> {
    (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()
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
        influences.extend([influence(joint, 1.0 - weight), influence(joint + 1, weight)]);
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
    let (mesh, report) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    assert_eq!(report.degenerate_triangles + report.duplicate_triangles, 0);
    Arc::new(mesh)
}

/// Positions and triangles of a closed sphere around the origin, of 200 columns around Y by 100 rows. A vertex is as
/// far from the origin as `radius` gives for its polar angle and azimuth; a pole is 1 away.
pub(crate) fn sphere(radius: impl Fn(f32, f32) -> f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    use core::f32::consts::PI;
    let (columns, rows) = (200, 100);
    let mut positions = vec![Vec3::Y, -Vec3::Y];
    for row in 1..rows {
        let polar = PI * row as f32 / rows as f32;
        for column in 0..columns {
            let azimuth = 2.0 * PI * column as f32 / columns as f32;
            let radius = radius(polar, azimuth);
            let ring = libm::sinf(polar) * radius;
            let (x, z) = (ring * libm::cosf(azimuth), ring * libm::sinf(azimuth));
            positions.push(Vec3::new(x, libm::cosf(polar) * radius, z));
        }
    }
    let at = |row: u32, column: u32| 2 + (row - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, at(1, column + 1), at(1, column)]);
        triangles.push([1, at(rows - 1, column), at(rows - 1, column + 1)]);
        for row in 1..rows - 1 {
            let (a, b) = (at(row, column), at(row, column + 1));
            let (c, d) = (at(row + 1, column), at(row + 1, column + 1));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    (positions, triangles)
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

/// Advances a surface by a tick, with its root at the origin.
pub(crate) fn advance(surface: &mut SkinnedSurface, palette: &Palette) {
    surface.advance(palette, Similarity::IDENTITY).unwrap();
}

/// The positions of all vertices of a surface.
pub(crate) fn positions_of(surface: &SkinnedSurface) -> Vec<Vec3> {
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    positions
}

/// The bits of positions.
pub(crate) fn bits(positions: &[Vec3]) -> Vec<[u32; 3]> {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    positions.iter().map(bits).collect()
}

/// The clusters below a child, left to right.
pub(crate) fn clusters_below(hierarchy: &Hierarchy, child: Child) -> Vec<u32> {
    match child {
        Child::Cluster(cluster) => vec![cluster],
        Child::Node(index) => {
            let node = &hierarchy.nodes[index as usize];
            let lanes = 0..usize::from(node.lanes);
            let below = lanes.flat_map(|lane| clusters_below(hierarchy, node.child(lane)));
            below.collect()
        }
    }
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
