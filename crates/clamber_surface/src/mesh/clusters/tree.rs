//! The binary tree whose leaves become the clusters. Its upper levels divide sets of whole parts, its lower levels
//! the triangles of one part.

use super::super::{PartId, TriangleId};

/// One side of a fork, or the root: another fork, or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branch {
    /// An index into [`Tree::forks`].
    Fork(u32),
    /// An index into [`Tree::leaves`]; also the index of the cluster.
    Leaf(u32),
}

/// A set of triangles cut in two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fork {
    pub(crate) sides: [Branch; 2],
    /// An estimate of how often queries reach each side: about the square of the radius of its bound.
    pub(crate) areas: [f32; 2],
}

/// The triangles of one cluster, in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leaf {
    pub(crate) part: PartId,
    pub(crate) triangles: Vec<TriangleId>,
}

/// The binary tree. Leaves are in depth-first order, left side first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tree {
    pub(crate) forks: Vec<Fork>,
    pub(crate) leaves: Vec<Leaf>,
    /// `None` for a mesh without triangles.
    pub(crate) root: Option<Branch>,
}
