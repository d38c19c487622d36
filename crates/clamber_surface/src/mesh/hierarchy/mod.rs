//! The bounding volume hierarchy over clusters: eight children a node, rest data only.
//!
//! A part that was edited has a tree of its own beside that of the whole; there its old clusters are
//! dead, and bounds hold more than they need.
//!
//! What bounds a child in a pose is computed from this and the palette, see [`crate::bounds`].

mod append;
mod build;
mod collapse;

use append::PartRoot;

/// Children of a node.
pub(crate) const LANES: usize = 8;

/// Most nodes and clusters that a traversal may have still to visit. Balanced trees need far fewer, see
/// [`Hierarchy::stack_needed`].
pub(crate) const STACK: usize = 256;

/// A node or a cluster, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    Node(u32),
    Cluster(u32),
}

/// The rest data of up to eight children, lane by lane. Lanes without a child hold zeros.
#[repr(C, align(64))]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    /// Centres of the rest balls.
    pub(crate) x: [f32; LANES],
    pub(crate) y: [f32; LANES],
    pub(crate) z: [f32; LANES],
    /// Their radii, rounded up.
    pub(crate) radius: [f32; LANES],
    /// Largest distances of rest positions from the mesh's origin, rounded up.
    pub(crate) reach: [f32; LANES],
    /// What f32 arithmetic may add to the bound, as a share of the size of what it adds up.
    pub(crate) inflation: [f32; LANES],
    /// As [`Child`], packed; see [`Node::child`].
    pub(crate) children: [u32; LANES],
    /// Its first row of [`Hierarchy::weights`] and [`Hierarchy::joints`].
    pub(crate) first_joint: u32,
    /// How many joints move any of its children.
    pub(crate) joints: u32,
    pub(crate) lanes: u8,
}

/// How much one joint moves each child of a node: the middle of the interval of its weights, and the
/// most by which a weight differs from that. Both 0 for a child that the joint does not move.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct JointWeights {
    pub(crate) middle: [f32; LANES],
    pub(crate) deviation: [f32; LANES],
}

/// All nodes, the first root first, every parent before its children.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Hierarchy {
    pub(crate) nodes: Vec<Node>,
    /// Joint ids, ascending in each node.
    pub(crate) joints: Vec<u32>,
    pub(crate) weights: Vec<JointWeights>,
    /// By part edited, in the order of the edits; beside node 0, which is a root always.
    further_roots: Vec<PartRoot>,
}

const CLUSTER: u32 = 1 << 31;

impl Child {
    pub(crate) fn packed(self) -> u32 {
        match self {
            Self::Node(index) => index,
            Self::Cluster(index) => index | CLUSTER,
        }
    }

    pub(crate) fn unpacked(packed: u32) -> Self {
        if packed & CLUSTER == 0 {
            Self::Node(packed)
        } else {
            Self::Cluster(packed & !CLUSTER)
        }
    }
}

impl Node {
    /// Without children.
    pub(crate) const EMPTY: Self = Self {
        x: [0.0; LANES],
        y: [0.0; LANES],
        z: [0.0; LANES],
        radius: [0.0; LANES],
        reach: [0.0; LANES],
        inflation: [0.0; LANES],
        children: [0; LANES],
        first_joint: 0,
        joints: 0,
        lanes: 0,
    };

    /// A bit for every lane that holds a child.
    pub(crate) fn lane_mask(&self) -> u8 {
        ((1u16 << self.lanes) - 1) as u8
    }

    /// The joints that move its children, ascending.
    pub(crate) fn joints<'a>(&self, hierarchy: &'a Hierarchy) -> &'a [u32] {
        let first = self.first_joint as usize;
        &hierarchy.joints[first..first + self.joints as usize]
    }

    /// How much each of them does.
    pub(crate) fn weights<'a>(&self, hierarchy: &'a Hierarchy) -> &'a [JointWeights] {
        let first = self.first_joint as usize;
        &hierarchy.weights[first..first + self.joints as usize]
    }

    /// The child in a lane below `lanes`.
    pub(crate) fn child(&self, lane: usize) -> Child {
        Child::unpacked(self.children[lane])
    }

    pub(crate) fn set_child(&mut self, lane: usize, child: Child) {
        self.children[lane] = child.packed();
    }
}

impl Hierarchy {
    /// The most nodes and clusters that a traversal has still to visit at once, which pushes all children of the node
    /// that it pops, in whatever order.
    pub(crate) fn stack_needed(&self) -> usize {
        let mut needed = vec![1; self.nodes.len()];
        let mut most = 1;
        // Every parent stands before its children.
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let lanes = usize::from(node.lanes);
            let below = (0..lanes).map(|lane| match node.child(lane) {
                Child::Node(child) => needed[child as usize],
                Child::Cluster(_) => 1,
            });
            needed[index] = lanes.max(1) - 1 + below.max().unwrap_or(1);
            most = most.max(needed[index]);
        }
        most
    }

    /// In bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.joints[..])
            + size_of_val(&self.weights[..])
            + size_of_val(&self.further_roots[..])
    }
}

#[cfg(test)]
mod tests;
