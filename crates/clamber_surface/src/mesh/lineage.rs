use std::fmt;

use glam::Vec3;

use super::{ColliderMesh, TriangleId, VertexId};
use crate::Fingerprint;
use crate::rig::JointId;

/// Identity of a mesh: a fingerprint of its positions, influences and triangles as built, and of every vertex and
/// triangle added since. Two meshes that were built from the same data and got the same additions in the same order
/// have the same id. Tags and removals do not count.
///
/// Hits and anchors carry the id that the mesh had when their triangle was built or added. So a point of one
/// creature is not mistaken for a point of another. A point on a triangle from the build is valid on every copy of
/// the mesh, however the copy was edited. A point on a triangle that an edit added is valid on copies that got the
/// same additions up to that triangle.
///
/// As text, and so in save games, an id is 16 hexadecimal digits. After edits that added something, `+` and the
/// number of added vertices and triangles follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct MeshId {
    /// Number of vertices and triangles added since the build.
    added: u64,
    fingerprint: u64,
}

impl fmt::Display for MeshId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.fingerprint)?;
        if self.added > 0 {
            write!(f, "+{}", self.added)?;
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for MeshId {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for MeshId {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
        let (fingerprint, added) = text.split_once('+').unwrap_or((&text, "0"));
        let numbers = (added.parse().ok()).zip(u64::from_str_radix(fingerprint, 16).ok());
        let id = numbers.map(|(added, fingerprint)| Self { added, fingerprint });
        // Only the form that `Display` writes is accepted.
        id.filter(|id| id.to_string() == text)
            .ok_or_else(|| D::Error::custom(format_args!("{text:?} is not a mesh id")))
    }
}

/// All ids that a mesh has had, from the build on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lineage {
    /// The fingerprint as built, then one after each added vertex or triangle.
    fingerprints: Vec<u64>,
    /// Number of triangles as built.
    built: usize,
    /// Per added triangle, the index of the fingerprint after it.
    added: Vec<u64>,
}

impl Lineage {
    /// The lineage of a mesh that has just been built.
    pub(super) fn of(mesh: &ColliderMesh) -> Self {
        let counts = [mesh.positions.len(), mesh.triangles.len()].map(|count| count as u32);
        let positions = mesh.positions.iter().flat_map(|p| p.to_array());
        let words = counts.into_iter().chain(positions.map(f32::to_bits));
        let words = words.chain(mesh.influences.words());
        let words = words.chain(mesh.triangles.iter().flatten().map(|corner| corner.0));
        Self {
            fingerprints: vec![fold(0, words)],
            built: mesh.triangles.len(),
            added: Vec::new(),
        }
    }

    pub(super) fn id(&self) -> MeshId {
        self.id_after(self.fingerprints.len().saturating_sub(1) as u64)
    }

    /// The id that the mesh had when `triangle` was built or added.
    pub(super) fn id_of(&self, triangle: TriangleId) -> MeshId {
        let added = triangle.index().checked_sub(self.built);
        let added = added.and_then(|added| self.added.get(added));
        self.id_after(added.copied().unwrap_or_default())
    }

    fn id_after(&self, added: u64) -> MeshId {
        let fingerprint = self.fingerprints.get(added as usize);
        MeshId {
            added,
            fingerprint: fingerprint.copied().unwrap_or_default(),
        }
    }

    /// True if `id` is the mesh's current id or one that it had before.
    pub(super) fn has(&self, id: MeshId) -> bool {
        let added = usize::try_from(id.added).ok();
        added.and_then(|added| self.fingerprints.get(added)) == Some(&id.fingerprint)
    }

    pub(super) fn add_vertex(&mut self, position: Vec3, influences: &[(JointId, u32)]) {
        let position = position.to_array().map(f32::to_bits);
        let influences = influences.iter();
        let influences = influences.flat_map(|(joint, units)| [joint.0, *units]);
        self.extend(position.into_iter().chain(influences));
    }

    pub(super) fn add_triangle(&mut self, corners: [VertexId; 3]) {
        self.extend(corners.iter().map(|corner| corner.0));
        self.added.push(self.id().added);
    }

    fn extend(&mut self, words: impl Iterator<Item = u32>) {
        let next = fold(self.id().fingerprint, words);
        self.fingerprints.push(next);
    }

    /// Size of the arrays in bytes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.fingerprints[..]) + size_of_val(&self.added[..])
    }
}

fn fold(hash: u64, words: impl Iterator<Item = u32>) -> u64 {
    let mut next = Fingerprint::new(hash);
    words.for_each(|word| next.word(u64::from(word)));
    next.value()
}
