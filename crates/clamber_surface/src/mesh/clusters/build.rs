//! From a mesh to clusters and the hierarchy over them.

use super::super::ColliderMesh;
use super::super::hierarchy::Hierarchy;
use super::refine::{Fans, refine};
use super::split::Splitter;
use super::tree::Tree;
use super::{Clusters, MAX_SLOTS};
use crate::mesh::summary::Summarizer;

/// Vertices that a leaf may have before its borders are straightened: few have more than
/// [`MAX_SLOTS`] after that, and cutting all that do at first would leave many half empty.
const RAGGED_SLOTS: usize = 72;

/// Clusters all triangles that have a part.
pub(crate) fn build(mesh: &ColliderMesh) -> (Clusters, Hierarchy) {
    build_beside(mesh, vec![false; mesh.positions().len()])
}

/// [`build`] beside other clusters: `held` says of each vertex whether one of them owns it.
pub(crate) fn build_beside(mesh: &ColliderMesh, held: Vec<bool>) -> (Clusters, Hierarchy) {
    let tree = cut(mesh);
    let clusters = Clusters::pack(mesh, &tree, held);
    let hierarchy = Hierarchy::over(mesh, &clusters, &tree);
    (clusters, hierarchy)
}

/// The tree of all parts.
pub(super) fn cut(mesh: &ColliderMesh) -> Tree {
    let mut splitter = Splitter::new(Summarizer::new(mesh));
    splitter.max_slots = RAGGED_SLOTS;
    splitter.mesh();
    // What has too many vertices still when its borders are straight is cut once more.
    let mut ragged = core::mem::take(&mut splitter.tree);
    let fans = Fans::new(mesh);
    refine(&mut splitter.summarizer, &fans, &mut ragged);
    splitter.max_slots = MAX_SLOTS;
    splitter.tree.root = ragged.root.map(|root| splitter.recut(&ragged, root));
    refine(&mut splitter.summarizer, &fans, &mut splitter.tree);
    splitter.tree
}
