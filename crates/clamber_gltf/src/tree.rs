//! The hierarchy of a file's nodes, checked once so that other code can walk it without checks.

use gltf::{Document, Node, Skin};

use crate::GltfErrorKind;

/// All nodes and skins of a file, and the hierarchy of the nodes. Every node has at most one parent, and there are no
/// cycles.
pub(crate) struct Tree<'a> {
    pub(crate) nodes: Vec<Node<'a>>,
    pub(crate) skins: Vec<Skin<'a>>,
    /// The parent of every node.
    pub(crate) parent_of: Vec<Option<usize>>,
    /// All nodes, every parent before its children.
    pub(crate) order: Vec<usize>,
}

impl<'a> Tree<'a> {
    pub(crate) fn new(document: &'a Document) -> Result<Self, GltfErrorKind> {
        let nodes: Vec<Node<'a>> = document.nodes().collect();
        let mut parent_of = vec![None; nodes.len()];
        for node in &nodes {
            for child in node.children() {
                let parent = &mut parent_of[child.index()];
                if let Some(other) = parent.filter(|other| *other != node.index()) {
                    return Err(GltfErrorKind::invalid(
                        format!("node {}", child.index()),
                        format!("is a child of nodes {other} and {}", node.index()),
                    ));
                }
                *parent = Some(node.index());
            }
        }
        let order = parents_first(&nodes, &parent_of)?;
        Ok(Self {
            nodes,
            skins: document.skins().collect(),
            parent_of,
            order,
        })
    }

    /// A node's name; `"node 3"` for node 3 without a name.
    pub(crate) fn name(&self, node: usize) -> String {
        let name = self.nodes[node].name();
        name.map_or_else(|| format!("node {node}"), str::to_owned)
    }
}

/// All nodes, by generation from the roots down. A node that cannot be reached from a root is an error: it is in a
/// cycle, or below one.
fn parents_first(
    nodes: &[Node<'_>],
    parent_of: &[Option<usize>],
) -> Result<Vec<usize>, GltfErrorKind> {
    let is_root = |node: &usize| parent_of[*node].is_none();
    let mut order: Vec<usize> = (0..nodes.len()).filter(is_root).collect();
    let mut placed = vec![false; nodes.len()];
    for root in &order {
        placed[*root] = true;
    }
    let mut next = 0;
    while let Some(node) = order.get(next).copied() {
        for child in nodes[node].children() {
            // A child that is listed twice is one child.
            if !std::mem::replace(&mut placed[child.index()], true) {
                order.push(child.index());
            }
        }
        next += 1;
    }
    match placed.iter().position(|placed| !placed) {
        Some(node) => Err(GltfErrorKind::invalid(
            format!("node {node}"),
            "is one of its own ancestors",
        )),
        None => Ok(order),
    }
}
