//! The binary tree of which clusters are the leaves: above, sets of whole parts; below, sets of
//! triangles of one part.

use super::super::{PartId, TriangleId};

/// What a fork leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Branch {
    /// An index into [`Tree::forks`].
    Fork(u32),
    /// An index into [`Tree::leaves`]; the cluster's own index.
    Leaf(u32),
}

/// A set of triangles cut in two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fork {
    pub(crate) sides: [Branch; 2],
    /// How often each side is met: about the square of the radius of its bound.
    pub(crate) areas: [f32; 2],
}

/// The triangles of one cluster, ascending.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leaf {
    pub(crate) part: PartId,
    pub(crate) triangles: Vec<TriangleId>,
}

/// Leaves stand in the order in which a walk from the root, left side first, meets them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tree {
    pub(crate) forks: Vec<Fork>,
    pub(crate) leaves: Vec<Leaf>,
    /// `None` for a mesh without triangles.
    pub(crate) root: Option<Branch>,
}
