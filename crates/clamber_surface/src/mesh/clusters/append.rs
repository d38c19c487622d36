//! Clusters of some parts in place of the ones that these had.

use std::collections::BTreeSet;

use super::super::{PartId, TriangleId, VertexId};
use super::{Cluster, Clusters, ROW};

/// Owns the vertices that no part does.
const NOBODY: PartId = PartId(u32::MAX);

/// What became of clusters whose parts were edited.
pub(crate) struct Killed {
    /// Those that are dead now, ascending.
    pub(crate) clusters: Vec<u32>,
    /// Vertices that they owned.
    vertices: Vec<VertexId>,
}

impl Clusters {
    /// Ends all clusters of some parts of a mesh that has so many vertices by now. Their places stay
    /// behind, without triangles and vertices.
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

    /// By vertex, of `vertices`: whether it has an owner.
    pub(crate) fn held(&self, vertices: &[VertexId]) -> Vec<bool> {
        let owners = vertices.iter().map(|v| self.owners[v.index()]);
        owners.map(|owner| owner != NOBODY).collect()
    }

    /// Appends the clusters of one part. They number vertices and triangles as `vertices` and
    /// `triangles` list them.
    pub(crate) fn append(
        &mut self,
        mut added: Self,
        part: PartId,
        vertices: &[VertexId],
        triangles: &[TriangleId],
    ) {
        for vertex in &mut added.vertices {
            // What pads a row is beyond them.
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

    /// Finds out which vertices are loose, after the last part was appended.
    pub(crate) fn settle(&mut self, killed: &Killed) {
        let owners = &self.owners;
        self.loose.extend(&killed.vertices);
        self.loose.retain(|v| owners[v.index()] == NOBODY);
        self.loose.sort();
        #[cfg(feature = "rayon")]
        self.ranks.forget();
    }

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

/// The vertices that a cluster owns, of the vertices of all.
fn owned<'a>(cluster: &Cluster, vertices: &'a [VertexId]) -> &'a [VertexId] {
    &vertices[cluster.first_row as usize * ROW..][..usize::from(cluster.owned)]
}
