//! Eager evaluation: computes all positions and bounds before they are requested.

use super::PosedMesh;
use crate::bounds::{Bounds, Boxes};
use crate::mesh::ColliderMesh;
use crate::mesh::hierarchy::Child;

impl PosedMesh {
    /// Skins every cluster and fits every bound to the skinned positions, children before parents.
    pub(crate) fn fill(&mut self, mesh: &ColliderMesh) {
        let nodes = &mesh.hierarchy().nodes;
        for (index, node) in nodes.iter().enumerate().rev() {
            let mut boxes = Boxes::EMPTY;
            for lane in 0..usize::from(node.lanes) {
                let sides = match node.child(lane) {
                    Child::Cluster(cluster) => self.fill_cluster(mesh, cluster as usize),
                    Child::Node(child) => match self.nodes.peek(child as usize) {
                        Some(Bounds::Boxes(boxes)) => boxes.union(),
                        // Never: children were fitted before.
                        _ => None,
                    },
                };
                if let Some(sides) = sides {
                    boxes.set(lane, sides);
                }
            }
            self.nodes
                .fill_ahead(index, |found| *found = Bounds::Boxes(boxes));
        }
    }

    /// Skins a cluster and returns the box around it; `None` if it is dead.
    fn fill_cluster(&mut self, mesh: &ColliderMesh, index: usize) -> Option<[[f32; 3]; 2]> {
        let clusters = mesh.clusters();
        let cluster = &clusters.clusters[index];
        if cluster.is_dead() {
            return None;
        }
        let mut sides = [[0.0; 3]; 2];
        let (level, palette) = (self.level, &self.palette);
        self.clusters.fill_ahead(index, |found| {
            found.skin(level, clusters, cluster, palette);
            sides = [found.low, found.high];
        });
        Some(sides)
    }
}
