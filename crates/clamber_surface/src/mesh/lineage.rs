use super::ColliderMesh;

/// Which mesh: a fingerprint of its positions, influences and triangles as they were built, and of each vertex and
/// triangle that was added since. The same wherever the same is built and added in the same order; tags do not count.
///
/// Hits and anchors carry it, so that what belongs to one creature is not taken for a point of another. What was found
/// before an edit still holds after it, on every copy that goes on from there; what was found after it holds only where
/// the same was added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MeshId {
    /// How many vertices and triangles were added.
    added: u64,
    fingerprint: u64,
}

/// All ids that a mesh has had.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lineage {
    /// As it was built, and after each vertex and triangle that was added.
    fingerprints: Vec<u64>,
}

impl Lineage {
    /// Of a mesh as it is built.
    pub(super) fn of(mesh: &ColliderMesh) -> Self {
        let positions = mesh.positions.iter().flat_map(|p| p.to_array());
        let numbers = positions.chain(mesh.weights.iter().copied());
        let words = numbers.map(f32::to_bits);
        let words = words.chain(mesh.influence_start.iter().copied());
        let words = words.chain(mesh.joints.iter().copied());
        let words = words.chain(mesh.triangles.iter().flatten().map(|corner| corner.0));
        Self {
            fingerprints: vec![fold(0xcbf2_9ce4_8422_2325, words)],
        }
    }

    pub(super) fn id(&self) -> MeshId {
        MeshId {
            added: self.fingerprints.len().saturating_sub(1) as u64,
            fingerprint: self.fingerprints.last().copied().unwrap_or_default(),
        }
    }

    /// True for the mesh's id and for those that it had before.
    pub(super) fn has(&self, id: MeshId) -> bool {
        let added = usize::try_from(id.added).ok();
        added.and_then(|added| self.fingerprints.get(added)) == Some(&id.fingerprint)
    }

    /// A vertex or a triangle was added.
    pub(super) fn add(&mut self, words: impl Iterator<Item = u32>) {
        self.fingerprints.push(fold(self.id().fingerprint, words));
    }

    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.fingerprints[..])
    }
}

/// FNV-1a (Fowler, Noll, Vo; RFC 9923), word by word.
fn fold(hash: u64, words: impl Iterator<Item = u32>) -> u64 {
    words.fold(hash, |hash, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
