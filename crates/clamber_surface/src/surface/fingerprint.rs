//! Hashes of poses and creatures, for comparing runs.

use glam::{Quat, Vec3};

use crate::Fingerprint;
use crate::geometry::Affine;
use crate::mesh::{ColliderMesh, SurfaceKind, VertexId};
use crate::rig::{Clip, Interpolation, Keyframes, Palette, Skeleton, Transform};

/// A 64-bit hash of every bit of a palette's matrices, for comparing runs.
pub fn palette_fingerprint(palette: &Palette) -> u64 {
    matrices_fingerprint(palette.matrices())
}

/// [`palette_fingerprint`] of a palette that is given by its matrices.
pub fn matrices_fingerprint(matrices: &[Affine]) -> u64 {
    let mut hash = Fingerprint::default();
    for matrix in matrices {
        add_affine(&mut hash, matrix);
    }
    hash.value()
}

/// A 64-bit hash of everything that determines a creature's motion, for comparing creatures.
///
/// The hash covers the joints, the clips with every key frame, and the mesh with its influences and tags. It leaves out
/// [`SurfaceTag::user`](crate::mesh::SurfaceTag::user).
pub fn creature_fingerprint(skeleton: &Skeleton, clips: &[Clip], mesh: &ColliderMesh) -> u64 {
    let mut hash = Fingerprint::default();
    hash.word(skeleton.joints().len() as u64);
    for joint in skeleton.joints() {
        hash.text(&joint.name);
        hash.word(joint.parent.map_or(u64::MAX, |parent| u64::from(parent.0)));
        add_transform(&mut hash, &joint.rest);
        add_affine(&mut hash, &joint.inverse_bind);
    }
    hash.word(clips.len() as u64);
    for clip in clips {
        add_clip(&mut hash, clip);
    }
    add_mesh(&mut hash, mesh);
    hash.value()
}

fn add_affine(hash: &mut Fingerprint, map: &Affine) {
    let [[a, b, c, d], [e, f, g, h], [i, j, k, l]] = map.rows;
    hash.floats(&[a, b, c, d, e, f, g, h, i, j, k, l]);
}

fn add_transform(hash: &mut Fingerprint, transform: &Transform) {
    hash.floats(&transform.translation.to_array());
    hash.floats(&transform.rotation.to_array());
    hash.floats(&transform.scale.to_array());
}

fn add_vectors(hash: &mut Fingerprint, values: &[Vec3]) {
    hash.word(values.len() as u64);
    for value in values {
        hash.floats(&value.to_array());
    }
}

fn add_rotations(hash: &mut Fingerprint, values: &[Quat]) {
    hash.word(values.len() as u64);
    for value in values {
        hash.floats(&value.to_array());
    }
}

fn add_clip(hash: &mut Fingerprint, clip: &Clip) {
    hash.text(&clip.name);
    hash.word(clip.channels().len() as u64);
    for channel in clip.channels() {
        hash.word(u64::from(channel.joint().0));
        hash.word(match channel.interpolation() {
            Interpolation::Step => 0,
            Interpolation::Linear => 1,
            Interpolation::CubicSpline => 2,
        });
        hash.word(channel.times().len() as u64);
        hash.floats(channel.times());
        match channel.values() {
            Keyframes::Translation(values) => {
                hash.word(0);
                add_vectors(hash, values);
            }
            Keyframes::Rotation(values) => {
                hash.word(1);
                add_rotations(hash, values);
            }
            Keyframes::Scale(values) => {
                hash.word(2);
                add_vectors(hash, values);
            }
        }
    }
}

fn add_mesh(hash: &mut Fingerprint, mesh: &ColliderMesh) {
    hash.word(mesh.joint_count() as u64);
    add_vectors(hash, mesh.positions());
    for vertex in 0..mesh.positions().len() {
        let influences = mesh.influences(VertexId(vertex as u32));
        hash.word(influences.len() as u64);
        for (joint, weight) in influences {
            hash.word(u64::from(joint.0) << 32 | u64::from(weight.to_bits()));
        }
    }
    hash.word(mesh.triangles().len() as u64);
    for (corners, tag) in mesh.triangles().iter().zip(mesh.tags().iter()) {
        for corner in corners {
            hash.word(u64::from(corner.0));
        }
        let kind = match tag.kind {
            SurfaceKind::Skin => 0,
            SurfaceKind::Fur => 1,
            SurfaceKind::Stone => 2,
        };
        hash.word(kind);
    }
}
