//! 64-bit hashes for comparing runs, not for hash tables. If any bit of the hashed data differs, the hash
//! differs too, in all likelihood.

use glam::{Quat, Vec3};

use crate::geometry::Affine;
use crate::mesh::{ColliderMesh, SurfaceKind, VertexId};
use crate::rig::{Clip, Interpolation, Keyframes, Palette, Skeleton, Transform};

/// Hashes 64-bit words one after another. It takes one multiplication per word, since it runs every tick.
#[derive(Clone, Copy, Debug)]
struct Fold(u64);

impl Fold {
    /// The first state: the offset basis of 64-bit FNV-1a.
    const START: Self = Self(0xcbf2_9ce4_8422_2325);

    fn word(&mut self, word: u64) {
        // 2^64 divided by the golden ratio: an odd number with well spread bits.
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn floats(&mut self, numbers: &[f32]) {
        let mut pairs = numbers.chunks_exact(2);
        for pair in &mut pairs {
            self.word(u64::from(pair[0].to_bits()) << 32 | u64::from(pair[1].to_bits()));
        }
        if let [last] = pairs.remainder() {
            self.word(u64::from(last.to_bits()));
        }
    }

    fn text(&mut self, text: &str) {
        self.word(text.len() as u64);
        for byte in text.bytes() {
            self.word(u64::from(byte));
        }
    }

    fn affine(&mut self, map: &Affine) {
        for row in &map.rows {
            self.floats(row);
        }
    }

    fn transform(&mut self, transform: &Transform) {
        self.floats(&transform.translation.to_array());
        self.floats(&transform.rotation.to_array());
        self.floats(&transform.scale.to_array());
    }

    fn vectors(&mut self, values: &[Vec3]) {
        self.word(values.len() as u64);
        for value in values {
            self.floats(&value.to_array());
        }
    }

    fn rotations(&mut self, values: &[Quat]) {
        self.word(values.len() as u64);
        for value in values {
            self.floats(&value.to_array());
        }
    }
}

/// A 64-bit hash of every bit of a palette's matrices, for comparing runs.
pub fn palette_fingerprint(palette: &Palette) -> u64 {
    matrices_fingerprint(palette.matrices())
}

/// [`palette_fingerprint`] of a palette that is given by its matrices.
pub fn matrices_fingerprint(matrices: &[Affine]) -> u64 {
    // Two folds side by side, since each multiplication waits for the one before it in the same fold.
    let (mut even, mut odd) = (Fold::START, Fold::START);
    for matrix in matrices {
        let [x, y, z] = &matrix.rows;
        let word = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
        even.word(word(x[0], x[1]));
        odd.word(word(x[2], x[3]));
        even.word(word(y[0], y[1]));
        odd.word(word(y[2], y[3]));
        even.word(word(z[0], z[1]));
        odd.word(word(z[2], z[3]));
    }
    even.word(odd.0);
    even.0
}

/// A 64-bit hash of everything that determines a creature's motion, for comparing creatures.
///
/// The hash covers the joints, the clips with every key frame, and the mesh with its influences and tags. It leaves out
/// [`SurfaceTag::user`](crate::mesh::SurfaceTag::user).
pub fn creature_fingerprint(skeleton: &Skeleton, clips: &[Clip], mesh: &ColliderMesh) -> u64 {
    let mut fold = Fold::START;
    fold.word(skeleton.joints().len() as u64);
    for joint in skeleton.joints() {
        fold.text(&joint.name);
        fold.word(joint.parent.map_or(u64::MAX, |parent| u64::from(parent.0)));
        fold.transform(&joint.rest);
        fold.affine(&joint.inverse_bind);
    }
    fold.word(clips.len() as u64);
    for clip in clips {
        add_clip(&mut fold, clip);
    }
    add_mesh(&mut fold, mesh);
    fold.0
}

fn add_clip(fold: &mut Fold, clip: &Clip) {
    fold.text(&clip.name);
    fold.word(clip.channels().len() as u64);
    for channel in clip.channels() {
        fold.word(u64::from(channel.joint().0));
        fold.word(match channel.interpolation() {
            Interpolation::Step => 0,
            Interpolation::Linear => 1,
            Interpolation::CubicSpline => 2,
        });
        fold.word(channel.times().len() as u64);
        fold.floats(channel.times());
        match channel.values() {
            Keyframes::Translation(values) => {
                fold.word(0);
                fold.vectors(values);
            }
            Keyframes::Rotation(values) => {
                fold.word(1);
                fold.rotations(values);
            }
            Keyframes::Scale(values) => {
                fold.word(2);
                fold.vectors(values);
            }
        }
    }
}

fn add_mesh(fold: &mut Fold, mesh: &ColliderMesh) {
    fold.word(mesh.joint_count() as u64);
    fold.vectors(mesh.positions());
    for vertex in 0..mesh.positions().len() {
        let influences = mesh.influences(VertexId(vertex as u32));
        fold.word(influences.len() as u64);
        for (joint, weight) in influences {
            fold.word(u64::from(joint.0) << 32 | u64::from(weight.to_bits()));
        }
    }
    fold.word(mesh.triangles().len() as u64);
    for (corners, tag) in mesh.triangles().iter().zip(mesh.tags().iter()) {
        for corner in corners {
            fold.word(u64::from(corner.0));
        }
        let kind = match tag.kind {
            SurfaceKind::Skin => 0,
            SurfaceKind::Fur => 1,
            SurfaceKind::Stone => 2,
        };
        fold.word(kind << 1 | u64::from(tag.ledge));
    }
}
