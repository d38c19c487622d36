//! Replaces the clusters of edited parts.

use std::collections::BTreeSet;

use super::super::{PartId, TriangleId, VertexId};
use super::{Cluster, Clusters, ROW};

/// Stands for the owner of vertices that no part owns.
const NOBODY: PartId = PartId(u32::MAX);

/// The clusters that an edit killed.
pub(crate) struct Killed {
    /// Their indices, in ascending order.
    pub(crate) clusters: Vec<u32>,
    /// The vertices that they owned.
    vertices: Vec<VertexId>,
}

impl Clusters {
    /// Kills all clusters of some parts. `vertices` is the current number of vertices of the mesh. Killed clusters
    /// stay in the array, without triangles and vertices.
    pub(crate) fn kill(&mut self, parts: &BTreeSet<PartId>, vertices: usize) -> Killed {
        self.find_owners();
        self.owners.resize(vertices, NOBODY);
        let mut killed = Killed {
            clusters: Vec::new(),
            vertices: Vec::new(),
        };
        for index in 0..self.clusters.len() {
            let cluster = self.clusters[index];
            if cluster.is_dead() || !parts.contains(&cluster.part) {
                continue;
            }
            for vertex in owned(&cluster, &self.vertices) {
                self.owners[vertex.index()] = NOBODY;
                killed.vertices.push(*vertex);
            }
            self.clusters[index] = Cluster {
                part: cluster.part,
                ..Cluster::NONE
            };
            killed.clusters.push(index as u32);
        }
        self.dead += killed.clusters.len();
        killed
    }

    /// For each of `vertices`, whether it has an owner.
    pub(crate) fn held(&self, vertices: &[VertexId]) -> Vec<bool> {
        let owners = vertices.iter().map(|v| self.owners[v.index()]);
        owners.map(|owner| owner != NOBODY).collect()
    }

    /// Appends the clusters of one part. The vertices and triangles in `added` are indices into `vertices` and
    /// `triangles`.
    pub(crate) fn append(
        &mut self,
        mut added: Self,
        part: PartId,
        vertices: &[VertexId],
        triangles: &[TriangleId],
    ) {
        for vertex in &mut added.vertices {
            // Padding is out of range and stays as it is.
            *vertex = vertices.get(vertex.index()).copied().unwrap_or(*vertex);
        }
        for triangle in &mut added.triangles {
            let known = triangles.get(triangle.index()).copied();
            *triangle = known.unwrap_or(*triangle);
        }
        let first_row = (self.vertices.len() / ROW) as u32;
        for cluster in &mut added.clusters {
            for vertex in owned(cluster, &added.vertices) {
                self.owners[vertex.index()] = part;
            }
            cluster.part = part;
            cluster.first_row += first_row;
            cluster.first_rest += self.rest.len() as u32;
            cluster.first_joint += self.joints.len() as u32;
            cluster.first_block += self.corners.len() as u32;
        }
        self.clusters.append(&mut added.clusters);
        self.rest.append(&mut added.rest);
        self.joints.append(&mut added.joints);
        self.corners.append(&mut added.corners);
        self.triangles.append(&mut added.triangles);
        self.vertices.append(&mut added.vertices);
    }

    /// Updates the list of loose vertices, after the last part was appended.
    pub(crate) fn settle(&mut self, killed: &Killed) {
        let owners = &self.owners;
        self.loose.extend(&killed.vertices);
        self.loose.retain(|v| owners[v.index()] == NOBODY);
        self.loose.sort();
        #[cfg(feature = "rayon")]
        self.ranks.forget();
    }

    /// Fills `owners`, unless an earlier edit did.
    fn find_owners(&mut self) {
        if !self.owners.is_empty() {
            return;
        }
        for cluster in &self.clusters {
            for vertex in owned(cluster, &self.vertices) {
                if self.owners.len() <= vertex.index() {
                    self.owners.resize(vertex.index() + 1, NOBODY);
                }
                self.owners[vertex.index()] = cluster.part;
            }
        }
    }
}

/// The vertices that a cluster owns. `vertices` holds the vertices of all clusters.
fn owned<'a>(cluster: &Cluster, vertices: &'a [VertexId]) -> &'a [VertexId] {
    &vertices[cluster.first_row as usize * ROW..][..usize::from(cluster.owned)]
}
