//! Builds the clusters of a mesh and the hierarchy over them.

use super::super::ColliderMesh;
use super::super::hierarchy::Hierarchy;
use super::refine::{Fans, refine};
use super::split::Splitter;
use super::tree::Tree;
use super::{Clusters, MAX_SLOTS};
use crate::mesh::summary::Summarizer;

/// Maximum number of vertices of a leaf before its borders are straightened. Few leaves exceed [`MAX_SLOTS`] after
/// that. Cutting all that exceed it before would leave many leaves half empty.
const RAGGED_SLOTS: usize = 72;

/// Builds the clusters of all triangles that belong to a part, and the hierarchy over them.
pub(crate) fn build(mesh: &ColliderMesh) -> (Clusters, Hierarchy) {
    build_beside(mesh, vec![false; mesh.positions().len()])
}

/// [`build`] beside existing clusters: `held` tells for each vertex whether one of them owns it.
pub(crate) fn build_beside(mesh: &ColliderMesh, held: Vec<bool>) -> (Clusters, Hierarchy) {
    let tree = cut(mesh);
    let clusters = Clusters::pack(mesh, &tree, held);
    let hierarchy = Hierarchy::over(mesh, &clusters, &tree);
    (clusters, hierarchy)
}

/// Cuts all parts into leaves that fit clusters.
pub(super) fn cut(mesh: &ColliderMesh) -> Tree {
    let mut splitter = Splitter::new(Summarizer::new(mesh));
    splitter.max_slots = RAGGED_SLOTS;
    splitter.mesh();
    // Leaves that still have too many vertices after their borders were straightened are cut again.
    let mut ragged = core::mem::take(&mut splitter.tree);
    let fans = Fans::new(mesh);
    refine(&mut splitter.summarizer, &fans, &mut ragged);
    splitter.max_slots = MAX_SLOTS;
    splitter.tree.root = ragged.root.map(|root| splitter.recut(&ragged, root));
    refine(&mut splitter.summarizer, &fans, &mut splitter.tree);
    splitter.tree
}
