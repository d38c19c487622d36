//! The bounding volume hierarchy over clusters: up to eight children per node, rest data only.
//!
//! An edited part gets a tree of its own beside the tree of the whole mesh. The part's old clusters in the tree of
//! the whole are dead, and the bounds above them are larger than necessary.
//!
//! [`crate::bounds`] computes the bounds of a pose from these data and the palette.

mod append;
mod build;
mod collapse;

use append::PartRoot;

/// Maximum number of children of a node: one per lane.
pub(crate) const LANES: usize = 8;

/// Size of the stack of a traversal: nodes and clusters that it still has to visit. Balanced trees need far fewer
/// entries, see [`Hierarchy::stack_needed`].
pub(crate) const STACK: usize = 256;

/// A child of a node: another node or a cluster. In [`Hierarchy::of_parts`], the index of a cluster is the index of a
/// part.
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
    /// Radii of the rest balls, rounded up.
    pub(crate) radius: [f32; LANES],
    /// Largest distance from the mesh's origin to a rest position or to the ball's centre, rounded up.
    pub(crate) reach: [f32; LANES],
    /// Upper bound of the f32 rounding error, as a share of the size of the numbers that are added up.
    /// `bounds/spheres.rs` derives it.
    pub(crate) inflation: [f32; LANES],
    /// Each a packed [`Child`]; see [`Node::child`].
    pub(crate) children: [u32; LANES],
    /// Index of the node's first row in [`Hierarchy::weights`] and [`Hierarchy::joints`].
    pub(crate) first_joint: u32,
    /// Number of joints that move any of its children.
    pub(crate) joints: u32,
    /// Number of children. They take the first lanes.
    pub(crate) lanes: u8,
}

/// The weight interval of one joint for each child of a node: its middle, and the largest difference of a weight
/// from the middle. Both are 0 for a child that the joint does not move.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct JointWeights {
    pub(crate) middle: [f32; LANES],
    pub(crate) deviation: [f32; LANES],
}

/// All nodes with their weights. Node 0 is the root of the whole mesh; every parent comes before its children.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Hierarchy {
    pub(crate) nodes: Vec<Node>,
    /// Joint ids, in ascending order within each node.
    pub(crate) joints: Vec<u32>,
    /// One row per entry of `joints`.
    pub(crate) weights: Vec<JointWeights>,
    /// The roots of the trees of edited parts, in the order of the edits. Node 0 is always a root too.
    further_roots: Vec<PartRoot>,
}

/// The bit that marks a cluster in a packed [`Child`]. The other bits are the index.
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
    /// A node without children.
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

    /// A mask with a bit for every lane that holds a child.
    pub(crate) fn lane_mask(&self) -> u8 {
        ((1u16 << self.lanes) - 1) as u8
    }

    /// The joints that move its children, ascending.
    pub(crate) fn joints<'a>(&self, hierarchy: &'a Hierarchy) -> &'a [u32] {
        let first = self.first_joint as usize;
        &hierarchy.joints[first..first + self.joints as usize]
    }

    /// The weights of the joints that move its children, in the order of [`Node::joints`].
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
    /// The most stack entries that a traversal can need, if it pushes all children of the node that it pops, in any
    /// order.
    pub(crate) fn stack_needed(&self) -> usize {
        let mut needed = vec![1; self.nodes.len()];
        let mut most = 1;
        // Every parent comes before its children.
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

    /// Size of the arrays in bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.joints[..])
            + size_of_val(&self.weights[..])
            + size_of_val(&self.further_roots[..])
    }
}

#[cfg(test)]
mod tests;
