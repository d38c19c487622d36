//! Trees of single parts, beside the tree of the whole.

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
    /// The roots beside node 0: a traversal starts from each, one after the other.
    pub(crate) fn further_roots(&self) -> impl Iterator<Item = u32> {
        self.further_roots.iter().map(|root| root.node)
    }

    /// Takes away the trees that parts have for themselves. Their nodes stay behind.
    pub(crate) fn cut_off(&mut self, parts: &BTreeSet<PartId>) {
        self.further_roots
            .retain(|root| !parts.contains(&root.part));
    }

    /// Appends the tree of one part, whose clusters were appended from `first_cluster` on.
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
