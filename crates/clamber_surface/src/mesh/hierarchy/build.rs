//! Fills the nodes of the hierarchy, from the root down.

use glam::Vec3;

use super::collapse::Collapse;
use super::{Child, Hierarchy, JointWeights, LANES, Node};
use crate::geometry::round_up_to_f32;
use crate::mesh::ColliderMesh;
use crate::mesh::clusters::Clusters;
use crate::mesh::clusters::tree::{Branch, Tree};
use crate::mesh::summary::{Summarizer, Summary};

/// State of the build while it walks the tree.
struct Builder<'a> {
    clusters: &'a Clusters,
    summarizer: Summarizer<'a>,
    collapse: Collapse<'a>,
    /// The rest positions of all slots, cluster by cluster.
    points: Vec<Vec3>,
    /// For each cluster, the index of its first point; then the number of points.
    starts: Vec<usize>,
    hierarchy: Hierarchy,
}

impl Hierarchy {
    /// The hierarchy over clusters that were packed from the leaves of `tree`. Without clusters it is a root
    /// without children.
    pub(crate) fn over(mesh: &ColliderMesh, clusters: &Clusters, tree: &Tree) -> Self {
        let (mut points, mut starts) = (Vec::new(), vec![0]);
        for cluster in &clusters.clusters {
            let vertices = cluster.vertices(clusters).iter();
            points.extend(vertices.map(|v| mesh.positions()[v.index()]));
            starts.push(points.len());
        }
        let mut builder = Builder {
            clusters,
            summarizer: Summarizer::new(mesh),
            collapse: Collapse::of(tree),
            points,
            starts,
            hierarchy: Self::default(),
        };
        builder.hierarchy.nodes.push(Node::EMPTY);
        let root = tree.root.map(|root| builder.collapse.lanes(root));
        if let Some(lanes) = root {
            builder.fill(0, 0, &lanes);
        }
        builder.hierarchy
    }

    /// A flat list of nodes whose children are the mesh's parts, except those without triangles. There is no tree
    /// above these nodes.
    pub(crate) fn of_parts(mesh: &ColliderMesh) -> Self {
        let mut summarizer = Summarizer::new(mesh);
        let parts = (0..).map(Child::Cluster).zip(mesh.parts());
        let filled = parts.filter(|(_, part)| !part.triangles.is_empty());
        let children: Vec<(Child, Summary)> = filled
            .map(|(child, part)| (child, summarizer.of_vertices(&part.vertices)))
            .collect();
        let mut hierarchy = Self::default();
        for children in children.chunks(LANES) {
            let node = hierarchy.node_of(children);
            hierarchy.nodes.push(node);
        }
        hierarchy
    }

    /// Makes a node with up to eight children, and appends its joints and weights to the arrays of the hierarchy.
    pub(crate) fn node_of(&mut self, children: &[(Child, Summary)]) -> Node {
        let spans = children.iter().flat_map(|(_, summary)| &summary.spans);
        let mut joints: Vec<u32> = spans.map(|span| span.joint).collect();
        joints.sort_unstable();
        joints.dedup();
        let first = self.weights.len();
        let mut node = Node {
            first_joint: first as u32,
            joints: joints.len() as u32,
            lanes: children.len() as u8,
            ..Node::EMPTY
        };
        self.weights
            .resize(first + joints.len(), JointWeights::default());
        let rows = &mut self.weights[first..];
        for (lane, (child, summary)) in children.iter().enumerate() {
            node.set_child(lane, *child);
            [node.x[lane], node.y[lane], node.z[lane]] = summary.ball.center.to_array();
            node.radius[lane] = summary.ball.radius;
            node.reach[lane] = summary.reach;
            let weights = summary.intervals();
            let deviations = weights.iter().map(|w| f64::from(w.deviation)).sum();
            node.inflation[lane] = inflation(summary.influences, weights.len(), deviations);
            for interval in weights {
                // Always found: `joints` holds the joints of all children.
                if let Ok(row) = joints.binary_search(&interval.joint) {
                    rows[row].middle[lane] = interval.middle;
                    rows[row].deviation[lane] = interval.deviation;
                }
            }
        }
        self.joints.append(&mut joints);
        node
    }
}

impl Builder<'_> {
    /// Fills node `index`, whose first cluster is `first`. Returns the summary of the node for its parent, and the
    /// index after the node's last cluster.
    fn fill(&mut self, index: usize, first: usize, lanes: &[Branch]) -> (Summary, usize) {
        // Siblings are adjacent in the array.
        let nodes = &mut self.hierarchy.nodes;
        let places = lanes.iter().map(|branch| match *branch {
            Branch::Leaf(cluster) => Child::Cluster(cluster),
            Branch::Fork(_) => {
                nodes.push(Node::EMPTY);
                Child::Node(nodes.len() as u32 - 1)
            }
        });
        let places: Vec<Child> = places.collect();
        let mut end = first;
        let mut children = Vec::with_capacity(lanes.len());
        for (place, branch) in places.into_iter().zip(lanes) {
            let (summary, next) = match place {
                Child::Cluster(cluster) => {
                    let cluster = &self.clusters.clusters[cluster as usize];
                    let vertices = cluster.vertices(self.clusters);
                    (self.summarizer.of_vertices(vertices), end + 1)
                }
                Child::Node(child) => {
                    let lanes = self.collapse.lanes(*branch);
                    self.fill(child as usize, end, &lanes)
                }
            };
            children.push((place, summary));
            end = next;
        }
        self.hierarchy.nodes[index] = self.hierarchy.node_of(&children);
        let points = &self.points[self.starts[first]..self.starts[end]];
        let union = self.summarizer.union(children.iter().map(|(_, s)| s));
        (union.bound(points), end)
    }
}

/// The square root of 3, rounded up.
const SQRT_3: f64 = 1.732_050_807_568_878;

/// [`Node::inflation`] of a child: `influences` is the most influences of one of its vertices, `joints` the number
/// of joints that move any of them, `deviations` the sum of the deviations of these joints. `bounds/spheres.rs`
/// derives it.
fn inflation(influences: usize, joints: usize, deviations: f64) -> f32 {
    let roundings = |count: f64| {
        let unit = f64::from(f32::EPSILON) * 0.5;
        count * unit / (1.0 - count * unit)
    };
    let skinning = roundings(influences as f64 + 4.0);
    let center = roundings(joints as f64 + 4.0);
    let images = deviations * roundings(4.0);
    let evaluation = 1.0 + 8.0 * f64::from(f32::EPSILON) * 0.5;
    round_up_to_f32(SQRT_3 * (skinning + center + images) * evaluation)
}
