//! Clusters: up to 64 vertices and 96 triangles of one part that are skinned together.
//!
//! The layout suits the skinning kernel: each cluster has a list of its joints and one row of weights per joint, as
//! a structure of arrays, so the kernel needs no gathers. A vertex on the border of several clusters is stored in
//! each of them; the first one owns it.
//!
//! When triangles of a part change, its clusters die, and new ones are appended. Other clusters keep their index
//! and their data.

mod append;
mod build;
mod pack;
mod parts;
mod refine;
mod split;
pub(crate) mod tree;

pub(crate) use build::{build, build_beside};

use super::{PartId, TriangleId, VertexId};

/// Maximum number of vertices of a cluster.
pub(crate) const MAX_SLOTS: usize = 64;

/// Maximum number of triangles of a cluster.
pub(crate) const MAX_TRIANGLES: usize = 96;

/// Number of slots in a row. A multiple of every SIMD width.
pub(crate) const ROW: usize = 16;

/// Number of triangles in a block.
pub(crate) const BLOCK: usize = 32;

/// One number for each of [`ROW`] slots.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Row(pub(crate) [f32; ROW]);

/// The corners of [`BLOCK`] triangles, as slots of their cluster. After the cluster's last triangle, all corners are 0.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CornerBlock(pub(crate) [[u8; BLOCK]; 3]);

/// The location of one cluster's data in the arrays of [`Clusters`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cluster {
    pub(crate) part: PartId,
    /// Index of its first row of slots.
    pub(crate) first_row: u32,
    /// Index of the first of its `rows * (3 + joints)` rows of rest data. Every sixteen slots take 3 + joints rows: x,
    /// y and z, then the weights of the first joint, of the second, and so on. Unused slots repeat the first slot.
    pub(crate) first_rest: u32,
    pub(crate) first_joint: u32,
    pub(crate) first_block: u32,
    pub(crate) joints: u32,
    /// Number of vertices.
    pub(crate) slots: u8,
    /// Number of vertices that the cluster owns: they come first. The others are copies.
    pub(crate) owned: u8,
    pub(crate) triangles: u8,
}

/// All clusters of a mesh, including dead ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Clusters {
    pub(crate) clusters: Vec<Cluster>,
    pub(crate) rest: Vec<Row>,
    /// Joint ids, in ascending order within each cluster.
    pub(crate) joints: Vec<u32>,
    pub(crate) corners: Vec<CornerBlock>,
    /// [`BLOCK`] per block. Entries after a cluster's last triangle are `TriangleId(u32::MAX)`.
    pub(crate) triangles: Vec<TriangleId>,
    /// [`ROW`] per row. Entries after a cluster's last slot are `VertexId(u32::MAX)`.
    pub(crate) vertices: Vec<VertexId>,
    /// Vertices that no cluster owns, in ascending order: those without triangles, and those that an edit took out
    /// of the part that owned them.
    pub(crate) loose: Vec<VertexId>,
    /// Number of dead clusters.
    pub(crate) dead: usize,
    /// Per vertex, the part whose cluster owns it. Empty before the first edit.
    owners: Vec<PartId>,
    /// See [`Clusters::ranks`].
    #[cfg(feature = "rayon")]
    ranks: super::derived::Derived<Vec<u32>>,
}

impl Cluster {
    /// A cluster without vertices or triangles.
    pub(crate) const NONE: Self = Self {
        part: PartId(0),
        first_row: 0,
        first_rest: 0,
        first_joint: 0,
        first_block: 0,
        joints: 0,
        slots: 0,
        owned: 0,
        triangles: 0,
    };

    /// True if an edit killed the cluster: it has no vertices or triangles any more.
    pub(crate) fn is_dead(&self) -> bool {
        self.triangles == 0
    }

    /// Number of rows that the cluster's slots take.
    pub(crate) fn rows(&self) -> usize {
        usize::from(self.slots).div_ceil(ROW)
    }

    /// The cluster's rows of rest data.
    pub(crate) fn rest<'a>(&self, clusters: &'a Clusters) -> &'a [Row] {
        let first = self.first_rest as usize;
        &clusters.rest[first..first + (3 + self.joints as usize) * self.rows()]
    }

    /// The cluster's joints, in ascending order.
    pub(crate) fn joints<'a>(&self, clusters: &'a Clusters) -> &'a [u32] {
        let first = self.first_joint as usize;
        &clusters.joints[first..first + self.joints as usize]
    }

    /// The cluster's vertices, slot by slot.
    pub(crate) fn vertices<'a>(&self, clusters: &'a Clusters) -> &'a [VertexId] {
        let first = self.first_row as usize * ROW;
        &clusters.vertices[first..first + usize::from(self.slots)]
    }

    /// The cluster's triangles.
    pub(crate) fn triangles<'a>(&self, clusters: &'a Clusters) -> &'a [TriangleId] {
        let first = self.first_block as usize * BLOCK;
        &clusters.triangles[first..first + usize::from(self.triangles)]
    }

    /// The corners of the cluster's triangles.
    pub(crate) fn corners<'a>(&self, clusters: &'a Clusters) -> &'a [CornerBlock] {
        let first = self.first_block as usize;
        &clusters.corners[first..first + usize::from(self.triangles).div_ceil(BLOCK)]
    }
}

impl Clusters {
    /// Per vertex, its rank among the owned vertices of all clusters, cluster by cluster; `u32::MAX` for a vertex
    /// that no cluster owns. `vertices` is the number of vertices of the mesh. Computed on first use.
    #[cfg(feature = "rayon")]
    pub(crate) fn ranks(&self, vertices: usize) -> &[u32] {
        self.ranks.get_or(|| {
            let mut ranks = vec![u32::MAX; vertices];
            let owned = |c: &Cluster| c.vertices(self)[..usize::from(c.owned)].to_vec();
            for (rank, vertex) in (0..).zip(self.clusters.iter().flat_map(owned)) {
                ranks[vertex.index()] = rank;
            }
            ranks
        })
    }

    /// Number of clusters that are not dead.
    pub(crate) fn living(&self) -> usize {
        self.clusters.len() - self.dead
    }

    /// Size of the arrays in bytes.
    pub(crate) fn memory(&self) -> usize {
        size_of_val(&self.clusters[..])
            + size_of_val(&self.rest[..])
            + size_of_val(&self.joints[..])
            + size_of_val(&self.corners[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.vertices[..])
            + size_of_val(&self.loose[..])
            + size_of_val(&self.owners[..])
    }
}

#[cfg(test)]
pub(super) mod tests;
