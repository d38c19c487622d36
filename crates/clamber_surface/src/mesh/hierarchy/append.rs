//! Trees of single edited parts, beside the tree of the whole mesh.

use std::collections::BTreeSet;

use super::{Child, Hierarchy};
use crate::mesh::PartId;

/// The root of a part's own tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PartRoot {
    part: PartId,
    node: u32,
}

impl Hierarchy {
    /// The roots other than node 0. A traversal starts from each of the roots in turn.
    pub(crate) fn further_roots(&self) -> impl Iterator<Item = u32> {
        self.further_roots.iter().map(|root| root.node)
    }

    /// Detaches the trees that some parts have of their own. The nodes stay in the array.
    pub(crate) fn cut_off(&mut self, parts: &BTreeSet<PartId>) {
        self.further_roots
            .retain(|root| !parts.contains(&root.part));
    }

    /// Appends the tree of one part. The clusters of the part are appended from index `first_cluster` on.
    pub(crate) fn append(&mut self, mut added: Self, part: PartId, first_cluster: u32) {
        let (first_node, first_joint) = (self.nodes.len() as u32, self.joints.len() as u32);
        for node in &mut added.nodes {
            node.first_joint += first_joint;
            for lane in 0..usize::from(node.lanes) {
                let child = match node.child(lane) {
                    Child::Node(index) => Child::Node(first_node + index),
                    Child::Cluster(index) => Child::Cluster(first_cluster + index),
                };
                node.set_child(lane, child);
            }
        }
        self.nodes.append(&mut added.nodes);
        self.joints.append(&mut added.joints);
        self.weights.append(&mut added.weights);
        self.further_roots.push(PartRoot {
            part,
            node: first_node,
        });
    }
}
