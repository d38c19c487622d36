//! Fills the nodes of the hierarchy, from the root down.

use super::collapse::Collapse;
use super::content::{Content, Points};
use super::intervals::intervals;
use super::{Child, Hierarchy, JointWeights, Node};
use crate::geometry::{round_up_to_f32, widen};
use crate::mesh::clusters::Clusters;
use crate::mesh::clusters::tree::{Branch, Tree};
use crate::surface::inflation;

/// Builds while the tree is walked.
struct Builder<'a> {
    clusters: &'a Clusters,
    collapse: Collapse<'a>,
    points: Points,
    hierarchy: Hierarchy,
}

impl Hierarchy {
    /// The hierarchy over clusters that were packed from the leaves of `tree`. Without clusters it
    /// is a root without lanes.
    pub(crate) fn over(clusters: &Clusters, tree: &Tree) -> Self {
        let mut builder = Builder {
            clusters,
            collapse: Collapse::of(tree),
            points: Points::of(clusters),
            hierarchy: Self::default(),
        };
        builder.hierarchy.nodes.push(Node::EMPTY);
        let lanes = tree
            .root
            .map(|root| builder.collapse.lanes(root))
            .unwrap_or_default();
        if !lanes.is_empty() {
            builder.fill(0, 0, &lanes);
        }
        builder.hierarchy
    }
}

impl Builder<'_> {
    /// Fills a node whose first cluster is `first`; returns what its own parent keeps of it, and the
    /// cluster after its last.
    fn fill(&mut self, index: usize, first: usize, lanes: &[Branch]) -> (Content, usize) {
        let mut node = Node::EMPTY;
        node.lanes = lanes.len() as u8;
        for (lane, branch) in lanes.iter().enumerate() {
            let child = match *branch {
                Branch::Leaf(cluster) => Child::Cluster(cluster),
                // Siblings stand side by side.
                Branch::Fork(_) => {
                    self.hierarchy.nodes.push(Node::EMPTY);
                    Child::Node(self.hierarchy.nodes.len() as u32 - 1)
                }
            };
            node.set_child(lane, child);
        }
        let mut end = first;
        let mut contents = Vec::with_capacity(lanes.len());
        for (lane, branch) in lanes.iter().enumerate() {
            let (content, next) = match node.child(lane) {
                Child::Cluster(cluster) => (self.cluster(cluster as usize), end + 1),
                Child::Node(child) => {
                    let lanes = self.collapse.lanes(*branch);
                    self.fill(child as usize, end, &lanes)
                }
            };
            contents.push(content);
            end = next;
        }
        self.write(&mut node, &contents);
        self.hierarchy.nodes[index] = node;
        let points = self.points.starts[first]..self.points.starts[end];
        let content = Content::of_node(&contents, &self.points.positions[points]);
        (content, end)
    }

    fn cluster(&self, index: usize) -> Content {
        let points = self.points.starts[index]..self.points.starts[index + 1];
        let points = &self.points.positions[points];
        Content::of_cluster(self.clusters, &self.clusters.clusters[index], points)
    }

    fn write(&mut self, node: &mut Node, contents: &[Content]) {
        let ranges = contents.iter().flat_map(|c| &c.ranges);
        let mut joints: Vec<u32> = ranges.map(|(joint, ..)| joint.0).collect();
        joints.sort_unstable();
        joints.dedup();
        let first = self.hierarchy.weights.len();
        let rows = JointWeights::default();
        self.hierarchy.weights.resize(first + joints.len(), rows);
        let rows = &mut self.hierarchy.weights[first..];
        for (lane, content) in contents.iter().enumerate() {
            let ball = content.ball;
            [node.x[lane], node.y[lane], node.z[lane]] = ball.center.to_array();
            node.radius[lane] = ball.radius;
            // The centre is moved like a vertex, so what that loses is that of the farther one.
            let center = widen(ball.center).length() * (1.0 + 1e-15);
            node.reach[lane] = round_up_to_f32(content.reach.max(center));
            let weights = intervals(&content.ranges).unwrap_or_default();
            let deviations = weights.iter().map(|w| f64::from(w.deviation)).sum();
            node.inflation[lane] = inflation(content.influences, weights.len(), deviations);
            for interval in weights {
                if let Ok(row) = joints.binary_search(&interval.joint.0) {
                    rows[row].middle[lane] = interval.middle;
                    rows[row].deviation[lane] = interval.deviation;
                }
            }
        }
        node.first_joint = self.hierarchy.joints.len() as u32;
        node.joints = joints.len() as u32;
        self.hierarchy.joints.append(&mut joints);
    }
}
